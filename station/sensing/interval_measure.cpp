#include <algorithm>
#include <cmath>

#include "station/drive/sine.hpp"
#include "station/sensing/interval_state.hpp"
#include "station/sensing/onset.hpp"

namespace turnpoint::sensing {

using terms::Proof;
using terms::ProofCause;

namespace {

constexpr double kLowest_Hz = 5000;    // distortion products below this frequency are ignored
constexpr double kApart_Hz = 20;       // distortion products closer than this to a tone are ignored
constexpr double kUnseenNoise = 0.05;  // a tone with a larger relative standard error is not judged
constexpr double kVibrates_dB = -10;   // the onset is not measured if the level relative to the plan is lower

}  // namespace

void IntervalProof::State::measure_tones() {
  double measured = 0, planned = 0;
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    const bool played = std::any_of(windows_.begin(), windows_.end(),
                                    [s](const Window& window) { return window.stretch == s; });
    if (cut_ && s > 0 && !played) continue;  // a stop came before this stretch, or just after it had begun
    for (std::size_t l = 0; l < stretches_[s].lines.size(); ++l) {
      const PlannedLine& line = stretches_[s].lines[l];
      measure_tone(s, line, l);
      const ToneProof& last = result_.tones.back();
      if (!last.seen) continue;
      double amplitude = 0;
      for (const PlannedTone& tone : line.tones) amplitude += tone.amplitude;
      planned += amplitude * amplitude;
      measured += amplitude * amplitude * std::pow(10, last.ratio_dB / 10);
    }
  }
  result_.ratio_dB = planned > 0 ? in_dB(std::sqrt(measured / planned)) : 0;
  vibrates_ = planned > 0 && result_.ratio_dB > kVibrates_dB;
}

// Adds a ToneProof for each tone of the line (all tones of one frequency). The figures are from the pick-up
// that responds best to this line.
void IntervalProof::State::measure_tone(std::size_t stretch, const PlannedLine& line, std::size_t place) {
  ToneProof made;
  made.stretch = stretches_[stretch].plan.changes;
  made.frequency_Hz = line.frequency_Hz;
  const auto p =
      static_cast<std::size_t>(std::max_element(line.seen.begin(), line.seen.end()) - line.seen.begin());
  const std::size_t lines = stretches_[stretch].lines.size();
  double power = 0, noise = 0;
  std::complex<double> sum = 0;
  int count = 0;
  for (const Window& window : windows_) {
    if (window.stretch != stretch || !window.valid) continue;
    const auto ratio = window.amplitude[p * lines + place] / line.expected[p];
    const double frames = static_cast<double>(window.end - window.first);
    noise = std::max(noise,
                     std::sqrt(2 * window.residual[p] / frames) / (line.gain * std::abs(line.expected[p])));
    power += std::norm(ratio);
    sum += ratio;
    ++count;
    const double dB = in_dB(std::abs(ratio));
    if (count == 1 || std::fabs(dB) > std::fabs(made.worst_ratio_dB)) made.worst_ratio_dB = dB;
  }
  made.seen = count > 0 && in_dB(line.seen[p]) >= plan_.limits.unseen_dB && noise < kUnseenNoise;
  if (made.seen) {
    made.pick_up = static_cast<int>(p);
    made.ratio_dB = in_dB(std::sqrt(power / count));
    made.phase_error_deg = std::arg(sum) * 180 / M_PI;
  } else {
    made.worst_ratio_dB = 0;
  }
  for (const PlannedTone& tone : line.tones) {
    made.tone = tone.index;
    made.drive_channel = tone.channel;
    result_.tones.push_back(made);
  }
}

void IntervalProof::State::measure_residual() {
  result_.residual_dB = result_.brief_dB = kNothing_dB;
  for (const Window& window : windows_) {
    const double planned = planned_power(stretches_[window.stretch].lines, main_);
    if (!window.valid || !(planned > 0)) continue;
    result_.residual_dB = std::max(result_.residual_dB, in_dB(std::sqrt(window.residual[main_] / planned)));
  }
  if (result_.residual_dB < plan_.limits.residual_dB.flag - 20) return;
  measure_products();
  measure_brief();
}

// A click is short: it hardly changes the rms of 0.2 s.
void IntervalProof::State::measure_brief() {
  const auto rest = unexplained();
  const double planned = rest.empty() ? 0 : planned_power(stretches_[windows_[*worst_].stretch].lines, main_);
  if (!(planned > 0)) return;
  const auto block = static_cast<std::size_t>(shape_.block_frames);
  for (std::size_t at = 0; at + block <= rest.size(); at += block) {
    double energy = 0;
    for (const double sample : rest.subspan(at, block)) energy += sample * sample;
    result_.brief_dB = std::max(result_.brief_dB, in_dB(std::sqrt(energy / static_cast<double>(block) / planned)));
  }
}

// Looks for the strongest distortion product of the tones (harmonic, combination, ...) in the window with the
// largest residual.
void IntervalProof::State::measure_products() {
  const auto rest = unexplained();
  if (rest.empty()) return;
  double planned = 0;
  std::vector<double> frequencies;
  for (const PlannedLine& line : stretches_[windows_[*worst_].stretch].lines) {
    planned += std::norm(line.expected[main_]) / 2;
    frequencies.push_back(line.frequency_Hz);
  }
  const int step = high_pass_step(plan_.rate_Hz);
  for (Product& product : products_of(frequencies, plan_.rate_Hz, kLowest_Hz, kApart_Hz)) {
    const double amplitude = amplitude_at(rest, product.frequency_Hz, plan_.rate_Hz) /
                             high_pass_gain(product.frequency_Hz, plan_.rate_Hz, step);
    product.level_dB = in_dB(amplitude / std::sqrt(2 * planned));
    if (!result_.product || product.level_dB > result_.product->level_dB) result_.product = product;
  }
}

// Returns the samples of the window with the largest residual, minus the fitted tones; empty if that window
// is not valid.
std::span<const double> IntervalProof::State::unexplained() {
  if (!worst_ || !windows_[*worst_].valid) return {};
  const Window& window = windows_[*worst_];
  const std::span<double> rest{worst_raw_.data(), static_cast<std::size_t>(window.end - window.first)};
  if (fit_subtracted_) return rest;
  fit_subtracted_ = true;
  const auto& lines = stretches_[window.stretch].lines;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const auto a = window.amplitude[main_ * lines.size() + l] * lines[l].gain;
    std::uint64_t phase = window.phase[l] + drive::phase_of_angle(std::arg(a));
    const double size = std::abs(a);
    for (double& sample : rest) {
      sample -= size * drive::sine_of_phase(phase);
      phase += lines[l].increment;
    }
  }
  return rest;
}

// Time at which the captured envelope passes half its level on the ramp, measured minus planned.
std::optional<double> IntervalProof::State::ramp_error_us(const RampWatch& watch, bool rising) const {
  const auto steady = std::find_if(windows_.begin(), windows_.end(), [&](const Window& w) {
    return w.valid && w.stretch == watch.stretch;
  });
  if (!watch.planned || !vibrates_ || steady == windows_.end()) return std::nullopt;
  const auto& lines = stretches_[watch.stretch].lines;
  const std::size_t count = lines.size();
  double power = 0;
  for (std::size_t l = 0; l < count; ++l)
    power += std::norm(steady->amplitude[main_ * count + l] * lines[l].gain);
  std::vector<double> envelope;
  for (std::size_t k = 0; k + count <= watch.points.size(); k += count) {
    double level = 0;
    for (std::size_t l = 0; l < count; ++l) {
      const auto wave = steady->amplitude[main_ * count + l] * lines[l].gain;
      level += (std::conj(wave) * watch.points[k + l]).real();
    }
    envelope.push_back(level / power);
  }
  if (!rising) std::reverse(envelope.begin(), envelope.end());
  const auto at = half_level(envelope);
  if (!at) return std::nullopt;
  const double place = rising ? *at : static_cast<double>(envelope.size() - 1) - *at;
  const double frame = static_cast<double>(watch.first_point) + place * shape_.block_frames;
  return (frame - watch.half_frame) / plan_.rate_Hz * 1e6;
}

void IntervalProof::State::find_lost() {
  const std::int64_t block = shape_.block_frames;
  const auto good = std::count(good_.begin(), good_.begin() + ((end_ - 1) / block - begin_ / block + 1), 1);
  result_.lost_frames = ((end_ - 1) / block - begin_ / block + 1 - good) * block;
  if (result_.lost_frames > 0) findings_.push_back({ProofCause::gap, Proof::lost});
}

// If a planned tone is missing, looks for a vibration within 8 % of its frequency. Returns the frequency of
// that vibration.
std::optional<double> IntervalProof::State::found_elsewhere(const ToneProof& tone) {
  if (result_.residual_dB < plan_.limits.residual_dB.stop - 20) return std::nullopt;
  const auto rest = unexplained();
  if (rest.empty() || stretches_[windows_[*worst_].stretch].plan.changes != tone.stretch) return std::nullopt;
  double planned = 0;
  for (const PlannedLine& line : stretches_[windows_[*worst_].stretch].lines)
    if (line.frequency_Hz == tone.frequency_Hz) planned = std::abs(line.expected[main_]);
  const int step = high_pass_step(plan_.rate_Hz);
  const double distance = plan_.rate_Hz / static_cast<double>(rest.size());
  double largest = 0, found = 0;
  for (double f = 0.92 * tone.frequency_Hz; f <= 1.08 * tone.frequency_Hz; f += distance) {
    const double amplitude = amplitude_at(rest, f, plan_.rate_Hz) / high_pass_gain(f, plan_.rate_Hz, step);
    if (amplitude > largest) {
      largest = amplitude;
      found = f;
    }
  }
  if (largest < 0.1 * planned) return std::nullopt;
  return found;
}

void IntervalProof::State::judge_tones(const Limits& level) {
  const ProofLimits& limits = plan_.limits;
  bool searched = false;
  for (const ToneProof& tone : result_.tones) {
    if (!tone.seen) {
      findings_.push_back({ProofCause::none, Proof::unproven});
      continue;
    }
    if (tone.ratio_dB < kVibrates_dB && !searched) {
      searched = true;
      result_.found_Hz = found_elsewhere(tone);
      if (result_.found_Hz) findings_.push_back({ProofCause::frequency, Proof::stopped});
    }
    if (tone.ratio_dB < limits.dead_dB)
      findings_.push_back({result_.found_Hz ? ProofCause::frequency : ProofCause::dead, Proof::stopped});
    findings_.push_back({ProofCause::level, judged(std::fabs(tone.worst_ratio_dB), level)});
    if (tone.ratio_dB > limits.dead_dB)
      findings_.push_back({ProofCause::phase, judged(std::fabs(tone.phase_error_deg), limits.phase_deg)});
  }
  for (int channel = 0; channel < drive::max_channels; ++channel) {
    int tones = 0, halved = 0;
    for (const ToneProof& tone : result_.tones) {
      if (!tone.seen || tone.drive_channel != channel) continue;
      ++tones;
      halved += tone.ratio_dB > limits.half_low_dB && tone.ratio_dB < limits.half_high_dB ? 1 : 0;
    }
    if (tones > 0 && halved == tones)
      findings_.push_back({ProofCause::half, judged(-limits.half_high_dB, level)});
  }
}

void IntervalProof::State::judge_glides(const Limits& level) {
  result_.glides.clear();
  for (const GlideProof& glide : glides_) {
    if (glide.failed()) findings_.push_back({ProofCause::none, Proof::unproven});
    for (const GlideToneProof& tone : glide.result(plan_.limits.unseen_dB)) {
      result_.glides.push_back(tone);
      if (!tone.seen) continue;
      findings_.push_back({ProofCause::level, judged(std::fabs(tone.worst_ratio_dB), level)});
      if (tone.worst_ratio_dB > plan_.limits.dead_dB)
        findings_.push_back(
            {ProofCause::phase, judged(std::fabs(tone.phase_error_deg), plan_.limits.phase_deg)});
    }
  }
}

void IntervalProof::State::judge_rest() {
  const ProofLimits& limits = plan_.limits;
  const double product = result_.product ? result_.product->level_dB : kNothing_dB;
  const Proof residual = judged(std::max(result_.residual_dB, product), limits.residual_dB);
  findings_.push_back({ProofCause::residual, residual});
  findings_.push_back({ProofCause::residual, judged(result_.brief_dB, brief_limits(limits))});
  if (result_.largest_sample >= limits.clipped) findings_.push_back({ProofCause::clipped, Proof::refused});
  // Clipping makes odd distortion products and reduces the level of the tones.
  if (product >= limits.residual_dB.flag && is_odd(result_.product->kind) && result_.ratio_dB < -0.1)
    findings_.push_back({ProofCause::clipped, residual});
  if (result_.onset_error_us)
    findings_.push_back({ProofCause::late, judged(std::fabs(*result_.onset_error_us), limits.onset_us)});
  else if (onset_.planned && vibrates_ && result_.lost_frames == 0 && !onset_.points.empty())
    findings_.push_back({ProofCause::late, Proof::refused});
  else
    findings_.push_back({ProofCause::none, Proof::unproven});
  if (result_.offset_error_us)
    findings_.push_back({ProofCause::offset, judged(std::fabs(*result_.offset_error_us), limits.onset_us)});
  else if (offset_.planned && vibrates_ && result_.lost_frames == 0 && !offset_.points.empty())
    findings_.push_back({ProofCause::offset, Proof::flagged});
  if (windows_.empty() || unplanned_) findings_.push_back({ProofCause::none, Proof::unproven});
}

void IntervalProof::State::conclude(std::optional<bool> in_contact) {
  findings_.clear();
  result_.tones.clear();
  result_.product.reset();
  result_.found_Hz.reset();
  measure_tones();
  measure_residual();
  result_.onset_error_us = ramp_error_us(onset_, true);
  result_.offset_error_us = ramp_error_us(offset_, false);
  find_lost();
  const ProofLimits& limits = plan_.limits;
  const Limits& level = in_contact.value_or(true) ? limits.level_in_contact_dB : limits.level_dB;
  judge_tones(level);
  judge_glides(level);
  judge_rest();
  result_.live_changes = live_changes_;
  const Finding all = concluded(findings_);
  result_.verdict = all.verdict;
  result_.cause = all.cause;
}

}  // namespace turnpoint::sensing
