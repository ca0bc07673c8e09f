#include "station/sensing/follow_proof.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

#include "station/audio/sine.hpp"

namespace turnpoint::sensing {
namespace {

using Complex = std::complex<double>;
using core::Proof;
using core::ProofCause;

constexpr double kAfterRamp_s = 0.005;  // the plate follows a ramp: 7 time constants at Q 60
constexpr double kBeyond_s = 0.02;   // beyond both ends of the gains, so that the transform may wrap around
constexpr double kAround_s = 0.005;  // so far from a gain that is not known, nothing is judged
constexpr double kLeast_s = 0.05;    // of judged time
constexpr double kLeastGain = 0.01;  // rms
constexpr double kMostLag_s = 0.003;
constexpr std::size_t kLagBlocks = 500;  // about so many blocks are used to find the lag
constexpr int kSmoothBins = 4;           // to both sides, when the residual's spectrum is smoothed
constexpr double kErrors = 3;            // a lag is beyond a limit if it is by so many standard errors

Proof by_size(double value, const Limits& limits) { return judged(std::fabs(value), limits); }

int block_frames_of(int rate_Hz) { return std::max(2, rate_Hz / 4000 * 2); }

std::vector<int> channels_of(const std::vector<PickUp>& pick_ups) {
  if (pick_ups.empty()) throw std::logic_error("proof: no pick-up");
  std::vector<int> channels;
  for (const auto& pick_up : pick_ups) channels.push_back(pick_up.channel);
  return channels;
}

Complex turned(std::uint64_t phase) noexcept {
  return {audio::sine_of_phase(phase + audio::quarter_cycle), audio::sine_of_phase(phase)};
}

/// Variance of the sum of the products of a regressor with a stationary residual: the power of the regressor
/// at each frequency times that of the residual around it. The mean of a residual says nothing, because the
/// level is fitted.
double variance_of_products(const std::vector<double>& regressor, const std::vector<double>& residual) {
  Eigen::FFT<double> transform;
  std::vector<Complex> of_regressor, of_residual;
  transform.fwd(of_regressor, regressor);
  transform.fwd(of_residual, residual);
  const auto n = static_cast<std::int64_t>(regressor.size());
  double sum = 0;
  for (std::int64_t k = 0; k < n; ++k) {
    double power = 0;
    int bins = 0;
    for (std::int64_t near = k - kSmoothBins; near <= k + kSmoothBins; ++near)
      if (near % n != 0) power += std::norm(of_residual[static_cast<std::size_t>((near + n) % n)]), ++bins;
    sum += std::norm(of_regressor[static_cast<std::size_t>(k)]) * power / bins;
  }
  return sum / static_cast<double>(n * n);
}

/// Sum of e^(i (phase + n increment)) over n from 0 to before `frames`, with integers of 2^-64 cycles.
Complex geometric(std::uint64_t phase, std::uint64_t increment, int frames) noexcept {
  const double step = 2 * M_PI * 0x1p-64 * static_cast<double>(static_cast<std::int64_t>(increment));
  const double middle =
      2 * M_PI * 0x1p-64 * static_cast<double>(static_cast<std::int64_t>(phase)) + 0.5 * (frames - 1) * step;
  const double half = 0.5 * step, sine = std::sin(half);
  const double size = std::abs(sine) < 1e-12 ? frames : std::sin(frames * half) / sine;
  return std::polar(1.0, middle) * size;
}

}  // namespace

FollowProof::FollowProof(const IntervalPlan& plan)
    : plan_(plan),
      blocks_(plan.rate_Hz, plan.capture_channels, channels_of(plan.pick_ups), block_frames_of(plan.rate_Hz),
              high_pass_step(plan.rate_Hz)) {
  const auto stretches = planned_stretches(plan.burst);
  if (stretches.empty() || plan.burst.change_count > 0) return;
  const auto& stretch = stretches.front();
  origin_frame_ = stretch.origin_frame;
  lines_ = planned_lines(stretch, plan_.pick_ups, plan.rate_Hz);
  if (lines_.empty()) return;
  pick_up_ = main_pick_up(lines_, plan_.pick_ups.size());
  const auto delay = static_cast<std::int64_t>(std::ceil(plan.delay_frames));
  first_ = stretch.first_frame + delay + std::llround(kAfterRamp_s * plan.rate_Hz);
  end_ = stretch.end_frame + delay;
}

void FollowProof::push(const CaptureBlock& block) {
  if (block.first_frame + block.frames() <= first_ - 2 * blocks_.block_frames() ||
      block.first_frame > end_ + 1000)
    return;
  blocks_.push(block, [this](const AlignedBlock& aligned) { take(aligned); });
}

void FollowProof::stopped(std::int64_t frame) noexcept {
  end_ = std::min(end_, frame + static_cast<std::int64_t>(plan_.delay_frames));
}

std::uint64_t FollowProof::phase_at(std::size_t line, std::int64_t captured_frame) const noexcept {
  const auto delay = static_cast<std::int64_t>(std::floor(plan_.delay_frames));
  const double fraction = plan_.delay_frames - static_cast<double>(delay);
  const auto& partial = lines_[line].tones.front().partial;
  return audio::advanced(partial, static_cast<std::uint64_t>(captured_frame - delay - origin_frame_)).phase -
         static_cast<std::uint64_t>(std::llround(fraction * static_cast<double>(partial.increment)));
}

void FollowProof::take(const AlignedBlock& block) {
  if (lines_.empty() || block.first_frame < first_ || block.first_frame + block.frames > end_) return;
  Block taken;
  taken.first_frame = block.first_frame;
  taken.lost = block.lost;
  taken.largest = block.largest;
  taken.energy = block.energy[pick_up_];
  taken.sums.resize(lines_.size());
  const double* row = block.row[pick_up_];
  for (std::size_t l = 0; l < lines_.size() && !block.lost; ++l) {
    std::uint64_t phase = phase_at(l, block.first_frame);
    const std::uint64_t increment = lines_[l].tones.front().partial.increment;
    Complex sum;
    for (std::int64_t n = 0; n < block.frames; ++n, phase += increment)
      sum += row[n] * std::conj(turned(phase));
    taken.sums[l] = Complex(0, 1) * sum;
  }
  taken_.push_back(std::move(taken));
}

/// What the pick-up should capture of each line: its complex amplitude over time, from the commanded gains.
struct FollowProof::Expected {
  Expected(const FollowProof& proof, const CommandedEnvelope& commanded) : step(commanded.step_frames) {
    const double rate = static_cast<double>(proof.plan_.rate_Hz) / step;
    lead = std::llround(kBeyond_s * rate);
    start_frame = commanded.start_frame - lead * step;
    const auto count = static_cast<std::int64_t>(commanded.gain.size());
    std::vector<double> gain(std::bit_ceil(static_cast<std::size_t>(count + 2 * lead)));
    known.assign(gain.size(), false);
    double last = 0;
    for (std::int64_t k = 0; k < count; ++k)
      if (std::isfinite(commanded.gain[static_cast<std::size_t>(k)])) {
        last = commanded.gain[static_cast<std::size_t>(k)];
        break;
      }
    for (std::size_t i = 0; i < gain.size(); ++i) {
      const auto k = static_cast<std::int64_t>(i) - lead;
      if (k >= 0 && k < count && std::isfinite(commanded.gain[static_cast<std::size_t>(k)]))
        last = commanded.gain[static_cast<std::size_t>(k)], known[i] = true;
      gain[i] = last;
    }
    Eigen::FFT<double> transform;
    std::vector<Complex> signal(gain.begin(), gain.end()), spectrum, filtered;
    transform.fwd(spectrum, signal);
    const auto& pick_up = proof.plan_.pick_ups[proof.pick_up_];
    const auto n = static_cast<double>(gain.size());
    for (const auto& line : proof.lines_) {
      const int channel = line.tones.front().partial.channel;
      const auto centre = response(pick_up, channel, line.frequency_Hz);
      auto made = spectrum;
      for (std::size_t k = 0; k < made.size() && centre; ++k) {
        const double place = static_cast<double>(k) - (2 * k < made.size() ? 0 : n);
        const auto near = response(pick_up, channel, line.frequency_Hz + place / n * rate);
        made[k] *= near.value_or(*centre) / *centre;
      }
      transform.inv(filtered, made);
      for (auto& value : filtered) value *= line.expected[proof.pick_up_] * line.gain;
      std::vector<Complex> integral(filtered.size());
      for (std::size_t k = 1; k < filtered.size(); ++k)
        integral[k] = integral[k - 1] + 0.5 * (filtered[k - 1] + filtered[k]);
      integrals.push_back(std::move(integral));
      lines.push_back(std::move(filtered));
    }
    half_block = 0.5 * proof.blocks_.block_frames() / step;
    around = std::llround(kAround_s * rate);
  }

  double place(double playback_frame) const {
    return (playback_frame - static_cast<double>(start_frame)) / step;
  }
  bool is_known(double at) const {
    const auto from = static_cast<std::int64_t>(at) - around, to = static_cast<std::int64_t>(at) + around / 2;
    if (from < 0 || to >= static_cast<std::int64_t>(known.size())) return false;
    return std::all_of(known.begin() + from, known.begin() + to + 1, [](bool one) { return one; });
  }
  /// Mean over the block whose middle is at this place. (Its value in the middle is not enough: a gain may
  /// jump within a block.)
  Complex at(std::size_t line, double place) const {
    return (integral_to(line, place + half_block) - integral_to(line, place - half_block)) / (2 * half_block);
  }
  /// How much the mean square over the block is above the square of its mean, summed over the lines. Sums
  /// over a block do not see this.
  double within(double place) const {
    double sum = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      double squares = 0;
      constexpr int parts = 8;
      for (int k = 0; k < parts; ++k)
        squares += std::norm(value(l, place + half_block * ((2 * k + 1.0) / parts - 1))) / parts;
      sum += std::max(0.0, squares - std::norm(at(l, place)));
    }
    return sum;
  }

  double clamped(std::size_t line, double place) const {
    return std::clamp(place, 0.0, static_cast<double>(lines[line].size() - 2));
  }
  Complex value(std::size_t line, double place) const {
    const double p = clamped(line, place);
    const auto k = static_cast<std::size_t>(p);
    return lines[line][k] + (p - static_cast<double>(k)) * (lines[line][k + 1] - lines[line][k]);
  }
  /// Of the straight lines between the points.
  Complex integral_to(std::size_t line, double place) const {
    const double p = clamped(line, place);
    const auto k = static_cast<std::size_t>(p);
    const double part = p - static_cast<double>(k);
    return integrals[line][k] + part * (lines[line][k] + 0.5 * part * (lines[line][k + 1] - lines[line][k]));
  }

  int step;
  double half_block = 0;
  std::int64_t lead = 0, start_frame = 0, around = 0;
  std::vector<bool> known;
  std::vector<std::vector<Complex>> lines, integrals;
};

IntervalResult FollowProof::result(const CommandedEnvelope& commanded, std::optional<bool> in_contact) const {
  IntervalResult result;
  if (lines_.empty() || commanded.gain.empty()) return result;
  const ProofLimits& limits = plan_.limits;
  for (const auto& line : lines_)
    if (line.expected[pick_up_] == Complex() || in_dB(line.seen[pick_up_]) < limits.unseen_dB) return result;
  const Expected expected(*this, commanded);
  const double middle = 0.5 * (blocks_.block_frames() - 1) - plan_.delay_frames;
  const int frames = blocks_.block_frames();

  std::vector<const Block*> used;
  for (const Block& block : taken_) {
    if (block.first_frame + frames > end_) continue;
    result.largest_sample = std::max(result.largest_sample, block.largest);
    if (block.lost) result.lost_frames += frames;
    const double at = expected.place(static_cast<double>(block.first_frame) + middle);
    if (block.lost || !expected.is_known(at)) continue;
    used.push_back(&block);
  }
  const auto full = planned_power(lines_, pick_up_) * frames;
  struct Match {
    Complex product;    ///< of the samples with what is expected
    double power = 0;   ///< sum of squares of what is expected
    double energy = 0;  ///< sum of squares of the samples
    double within =
        0;  ///< sum of squares that is expected in addition, because the amplitude varies in blocks
    double remains() const { return std::max(0.0, energy - std::norm(product) / power); }
    /// What was not expected. (For the lag, what is expected within blocks must not count: a lag at which
    /// more is expected would look better.)
    double unexpected() const {
      return std::max(0.0, energy - std::norm(product) / power * (1 + within / power));
    }
  };
  const auto match = [&](const std::vector<const Block*>& blocks, double lag_frames) {
    Match sum;
    std::vector<Complex> x(lines_.size());
    std::vector<std::uint64_t> phase(lines_.size());
    for (const Block* block : blocks) {
      sum.energy += block->energy;
      const double at = expected.place(static_cast<double>(block->first_frame) + middle - lag_frames);
      sum.within += 0.5 * frames * expected.within(at);
      for (std::size_t l = 0; l < lines_.size(); ++l) {
        x[l] = expected.at(l, at);
        phase[l] = phase_at(l, block->first_frame);
        // samples A sin(phase + theta): their products are A e^(i theta) frames / 2
        sum.product += block->sums[l] * std::conj(x[l]);
      }
      for (std::size_t l = 0; l < lines_.size(); ++l)
        for (std::size_t m = 0; m <= l; ++m) {
          const std::uint64_t a = lines_[l].tones.front().partial.increment,
                              b = lines_[m].tones.front().partial.increment;
          sum.power +=
              (l == m ? 0.5 : 1) *
                  (x[l] * std::conj(x[m]) * geometric(phase[l] - phase[m], a - b, frames)).real() -
              (l == m ? 0.5 : 1) * (x[l] * x[m] * geometric(phase[l] + phase[m], a + b, frames)).real();
        }
    }
    return sum;
  };
  const auto here = match(used, 0);
  const auto judged_frames = static_cast<double>(used.size()) * frames;
  const bool long_enough = judged_frames >= kLeast_s * plan_.rate_Hz;
  const double gains =
      long_enough && full > 0 ? std::sqrt(std::max(0.0, here.power) * frames / (full * judged_frames)) : 0;
  if (!long_enough || gains < kLeastGain) {
    if (result.lost_frames > 0) result.verdict = Proof::lost, result.cause = ProofCause::gap;
    return result;
  }
  const Complex scale = here.product / here.power;
  result.ratio_dB = in_dB(std::abs(scale));
  const double phase_deg = std::arg(scale) * 180 / M_PI;
  result.residual_dB = in_dB(std::sqrt(here.unexpected() / std::max(std::norm(scale) * here.power, 1e-300)));
  result.envelope_error_dB = result.residual_dB;

  // The lag, if it is known well enough. A part of the blocks is enough.
  std::vector<const Block*> some;
  for (std::size_t k = 0; k < used.size(); k += 1 + used.size() / kLagBlocks) some.push_back(used[k]);
  const double step = 2 * expected.step;
  const auto most = static_cast<int>(std::lround(kMostLag_s * plan_.rate_Hz / step));
  // The lag is fitted by least squares together with level and phase. This is its standard error. All values
  // are relative to the phase that is expected of a block.
  const auto lag_error_frames = [&](double lag_frames) {
    const Match all = match(some, lag_frames);
    const Complex level = all.product / all.power;
    std::vector<double> expects;
    std::vector<Complex> slopes, residuals;
    Complex common;
    for (const Block* block : some) {
      const Match one = match({block}, lag_frames);
      const double at = expected.place(static_cast<double>(block->first_frame) + middle - lag_frames);
      Complex change;
      double size = 0;
      for (std::size_t l = 0; l < lines_.size(); ++l) {
        const Complex x = expected.at(l, at);
        change += (expected.at(l, at - 1) - expected.at(l, at + 1)) * std::conj(x);
        size += std::norm(x);
      }
      if (!(one.power * static_cast<double>(some.size()) > kLeastGain * kLeastGain * all.power)) continue;
      expects.push_back(std::sqrt(one.power));
      slopes.push_back(expects.back() * change / (2 * expected.step * size));
      residuals.push_back(std::conj(level) / std::abs(level) * (one.product - level * one.power) /
                          expects.back());
      common += slopes.back() * expects.back() / all.power;
    }
    std::array<std::vector<double>, 2> slope, residual;  // real and imaginary parts
    double squares = 0;
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      const Complex own = std::abs(level) * (slopes[j] - common * expects[j]);
      squares += std::norm(own);
      slope[0].push_back(own.real()), slope[1].push_back(own.imag());
      residual[0].push_back(residuals[j].real()), residual[1].push_back(residuals[j].imag());
    }
    const double variance =
        variance_of_products(slope[0], residual[0]) + variance_of_products(slope[1], residual[1]);
    return squares > 0 ? std::sqrt(variance) / squares : std::numeric_limits<double>::infinity();
  };
  std::vector<double> left;
  for (int k = -most; k <= most; ++k) left.push_back(match(some, k * step).remains());
  const auto best = static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin());
  double lag_error_us = 0;
  if (best > 0 && best + 1 < left.size()) {
    const double bend = left[best - 1] - 2 * left[best] + left[best + 1];
    const double part = bend > 0 ? 0.5 * (left[best - 1] - left[best + 1]) / bend : 0;
    const double lag_frames = (static_cast<double>(best) - most + part) * step;
    lag_error_us = 1e6 * lag_error_frames(lag_frames) / plan_.rate_Hz;
    if (kErrors * lag_error_us <= limits.envelope_lag_us.flag)
      result.envelope_lag_us = 1e6 * lag_frames / plan_.rate_Hz;
  }

  for (const auto& line : lines_)
    for (const auto& tone : line.tones) {
      ToneProof made;
      made.tone = tone.index;
      made.drive_channel = tone.partial.channel;
      made.frequency_Hz = line.frequency_Hz;
      made.seen = true;
      made.pick_up = static_cast<int>(pick_up_);
      made.ratio_dB = made.worst_ratio_dB = result.ratio_dB;
      made.phase_error_deg = phase_deg;
      result.tones.push_back(made);
    }

  std::vector<Finding> findings;
  if (result.lost_frames > 0) findings.push_back({ProofCause::gap, Proof::lost});
  if (result.largest_sample >= limits.clipped) findings.push_back({ProofCause::clipped, Proof::refused});
  if (result.ratio_dB < limits.dead_dB) {
    findings.push_back({ProofCause::dead, Proof::stopped});
  } else {
    const auto& level = in_contact.value_or(true) ? limits.level_in_contact_dB : limits.level_dB;
    findings.push_back({ProofCause::level, by_size(result.ratio_dB, level)});
    findings.push_back({ProofCause::phase, by_size(phase_deg, limits.phase_deg)});
    findings.push_back({ProofCause::residual, judged(*result.envelope_error_dB, limits.envelope_error_dB)});
    if (result.envelope_lag_us)
      findings.push_back(
          {ProofCause::late,
           judged(std::fabs(*result.envelope_lag_us) - kErrors * lag_error_us, limits.envelope_lag_us)});
  }
  const Finding all = concluded(findings);
  result.verdict = all.verdict;
  result.cause = all.cause;
  return result;
}

}  // namespace turnpoint::sensing
