#include "station/sensing/glide_proof.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "station/audio/burst.hpp"
#include "station/audio/sine.hpp"
#include "station/sensing/planned_lines.hpp"

namespace turnpoint::sensing {
namespace {

using Amplitude = std::complex<double>;

// The computation treats the signal as periodic. After this time, the surface no longer shows the jump from
// the end to the beginning: 7 time constants of a resonance at 22 kHz with a Q of 200.
constexpr double kLead_s = 0.02;
// The reduced rate is the range of frequencies that the tone passes, plus kMargin_Hz for the surface's
// reaction, plus a part for the glide itself, which is broader the shorter the glide is.
constexpr double kMargin_Hz = 6000, kPerGlide = 500;

Amplitude turned(std::uint64_t phase) noexcept {
  return {audio::sine_of_phase(phase + audio::quarter_cycle), audio::sine_of_phase(phase)};
}

const Transfer* calibration_of(const PickUp& pick_up, int channel) {
  for (const Transfer& transfer : pick_up.transfers)
    if (transfer.drive_channel == channel) return &transfer;
  return nullptr;
}

}  // namespace

audio::Partial tone_at(const PlayedTone& tone, std::int64_t frames, std::int64_t frame) noexcept {
  audio::Partial partial = tone.partial;
  const std::int64_t gliding = std::clamp<std::int64_t>(frame, 0, frames);
  partial = audio::advanced(partial, static_cast<std::uint64_t>(gliding));
  partial.amplitude += partial.amplitude_change * (frame < 0 ? 0 : audio::ramp_at(frame, frames));
  if (frame == gliding) return partial;
  partial.phase += partial.increment * static_cast<std::uint64_t>(frame - gliding);
  partial.curvature = 0;
  return partial;
}

GlideResponse::GlideResponse(const Glide& glide, const PlayedTone& tone, const PickUp& pick_up, int rate_Hz,
                             std::int64_t tail_frames) {
  const auto hertz = [rate_Hz](std::uint64_t increment) {
    return static_cast<double>(static_cast<std::int64_t>(increment)) * 0x1p-64 * rate_Hz;
  };
  const int channel = tone.partial.channel;
  const std::uint64_t from = tone.partial.increment, to = tone_at(tone, glide.frames, glide.frames).increment;
  if (!response(pick_up, channel, hertz(from)) || !response(pick_up, channel, hertz(to))) return;
  const double seconds = static_cast<double>(glide.frames) / rate_Hz;
  const double band_Hz = std::fabs(hertz(to - from)) + kMargin_Hz + kPerGlide / seconds;
  step_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(rate_Hz / band_Hz));
  lead_ = std::llround(kLead_s * rate_Hz) / step_ * step_;
  const auto needed = static_cast<std::uint64_t>((lead_ + glide.frames + tail_frames) / step_ + 2);
  values_.resize(std::bit_ceil(needed));

  // the tone, shifted down by the frequency in the middle of the glide
  const std::uint64_t middle = from + static_cast<std::uint64_t>(static_cast<std::int64_t>(to - from) / 2);
  std::vector<Amplitude> turn(values_.size());
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const std::int64_t frame = static_cast<std::int64_t>(k) * step_ - lead_;
    const audio::Partial now = tone_at(tone, glide.frames, frame);
    turn[k] = turned(now.phase - middle * static_cast<std::uint64_t>(frame));
    values_[k] = now.amplitude * turn[k];
  }
  const Transfer& calibrated = *calibration_of(pick_up, channel);
  const double low_Hz = calibrated.frequency_Hz.front(), high_Hz = calibrated.frequency_Hz.back();
  const auto count = static_cast<double>(values_.size());
  Eigen::FFT<double> transform;
  std::vector<Amplitude> spectrum;
  transform.fwd(spectrum, values_);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double place = static_cast<double>(k) - (2 * k < values_.size() ? 0 : count);
    const double frequency_Hz = hertz(middle) + place / count * rate_Hz / static_cast<double>(step_);
    spectrum[k] *= *response(pick_up, channel, std::clamp(frequency_Hz, low_Hz, high_Hz));
  }
  transform.inv(values_, spectrum);
  for (std::size_t k = 0; k < values_.size(); ++k) values_[k] *= std::conj(turn[k]);
}

std::complex<double> GlideResponse::at(double frame) const noexcept {
  if (values_.empty()) return 0;
  const double place = std::clamp((frame + static_cast<double>(lead_)) / static_cast<double>(step_), 0.0,
                                  static_cast<double>(values_.size() - 2));
  const auto below = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(below);
  return (1 - part) * values_[below] + part * values_[below + 1];
}

namespace {

constexpr std::int64_t kWindowBlocks = 5;  // of 1 ms
constexpr double kWeak = 0.01;  // a line with a smaller share of the strongest line's power is not fitted
constexpr double kUncertain = 0.05;  // a line whose standard error is larger is not judged

}  // namespace

GlideProof::GlideProof(const Glide& glide, std::int64_t first_frame, std::int64_t end_frame,
                       const std::vector<PickUp>& pick_ups, int rate_Hz, int block_frames,
                       double delay_frames)
    : glide_(glide),
      rate_Hz_(rate_Hz),
      block_frames_(block_frames),
      delay_(static_cast<std::int64_t>(std::floor(delay_frames))),
      delay_fraction_(delay_frames - std::floor(delay_frames)),
      end_(end_frame),
      pick_ups_(pick_ups.size()),
      joint_(glide.tones.size()) {
  const std::int64_t tail = end_frame - delay_ - glide.first_frame - glide.frames + block_frames;
  add_lines(pick_ups, std::max<std::int64_t>(0, tail));
  const std::int64_t blocks = (end_frame - first_frame) / block_frames;
  const std::int64_t count = std::max<std::int64_t>(1, (blocks + kWindowBlocks / 2) / kWindowBlocks);
  for (std::int64_t k = 0; k < count && blocks > 0; ++k)
    windows_.push_back({first_frame + blocks * k / count * block_frames,
                        first_frame + blocks * (k + 1) / count * block_frames, false,
                        std::vector<Fit>(pick_ups_ * lines_.size())});
  const std::size_t unknowns = 2 * lines_.size();
  columns_.resize(unknowns * static_cast<std::size_t>(block_frames));
  planned_.resize(lines_.size());
  waves_.resize(lines_.size() * static_cast<std::size_t>(block_frames));
  gram_.resize(pick_ups_ * unknowns * unknowns);
  right_.resize(pick_ups_ * unknowns);
  energy_.resize(pick_ups_);
}

// Joins tones of equal frequency, and computes what each pick-up captures of them.
void GlideProof::add_lines(const std::vector<PickUp>& pick_ups, std::int64_t tail_frames) {
  for (const PlayedTone& tone : glide_.tones) {
    auto same = std::find_if(lines_.begin(), lines_.end(), [&](const Line& line) {
      const auto& partial = line.tones.front().partial;
      return partial.increment == tone.partial.increment && partial.curvature == tone.partial.curvature;
    });
    if (same == lines_.end()) same = lines_.insert(lines_.end(), Line{});
    same->tones.push_back(tone);
  }
  for (Line& line : lines_) {
    for (const PlayedTone& tone : line.tones) {
      const auto turn = static_cast<std::int64_t>(tone.partial.phase - line.tones.front().partial.phase);
      line.turns.push_back(std::polar(1.0, 2 * M_PI * 0x1p-64 * static_cast<double>(turn)));
    }
    line.responses.resize(pick_ups_);
    for (std::size_t p = 0; p < pick_ups_; ++p) {
      bool known = true;
      for (const PlayedTone& tone : line.tones) {
        line.responses[p].emplace_back(glide_, tone, pick_ups[p], rate_Hz_, tail_frames);
        known = known && line.responses[p].back().calibrated();
      }
      line.best.push_back(known ? best_response(pick_ups[p]) : 0);
    }
  }
}

void GlideProof::fill_waves(const AlignedBlock& block) noexcept {
  const std::int64_t first = block.first_frame - delay_ - glide_.first_frame;
  const int step = high_pass_step(rate_Hz_);
  const auto gain_of = [&](std::uint64_t increment) {
    return high_pass_gain(static_cast<double>(increment) * 0x1p-64 * rate_Hz_, rate_Hz_, step);
  };
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const PlayedTone& tone = lines_[l].tones.front();
    audio::Partial now = tone_at(tone, glide_.frames, first);
    const double gain = gain_of(now.increment);
    const double rise = gain_of(tone_at(tone, glide_.frames, first + block_frames_).increment) - gain;
    auto* wave = waves_.data() + l * static_cast<std::size_t>(block_frames_);
    for (int n = 0; n < block_frames_; ++n) {
      const auto of_fraction =
          static_cast<std::uint64_t>(std::llround(static_cast<double>(now.increment) * delay_fraction_));
      const std::uint64_t phase = now.phase - of_fraction;
      wave[n] = (gain + rise * n / block_frames_) *
                std::complex<double>(audio::sine_of_phase(phase + audio::quarter_cycle),
                                     audio::sine_of_phase(phase));
      now.phase += now.increment;
      if (first + n >= 0 && first + n < glide_.frames) now.increment += tone.partial.curvature;
    }
    double planned = 0;
    for (const PlayedTone& one : lines_[l].tones)
      planned += tone_at(one, glide_.frames, first + block_frames_ / 2).amplitude;
    planned_[l] += planned * planned * (gain + rise / 2) * (gain + rise / 2) * block_frames_;
  }
}

// The tones of a line differ only in amplitude and by a constant phase.
void GlideProof::fill_columns(std::size_t pick_up, const AlignedBlock& block) noexcept {
  const auto frames = static_cast<std::size_t>(block_frames_);
  const double first = static_cast<double>(block.first_frame - delay_ - glide_.first_frame) - delay_fraction_;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const Line& line = lines_[l];
    const auto* wave = waves_.data() + l * frames;
    double* sine = columns_.data() + 2 * l * frames;
    double* cosine = sine + frames;
    for (std::size_t n = 0; n < frames; ++n) {
      std::complex<double> response = 0;
      for (std::size_t t = 0; t < line.tones.size(); ++t)
        response += line.turns[t] * line.responses[pick_up][t].at(first + static_cast<double>(n));
      sine[n] = response.real() * wave[n].imag() + response.imag() * wave[n].real();
      cosine[n] = response.real() * wave[n].real() - response.imag() * wave[n].imag();
    }
  }
}

void GlideProof::add_products(std::size_t pick_up, const AlignedBlock& block) noexcept {
  const auto frames = static_cast<std::size_t>(block_frames_);
  const std::size_t unknowns = 2 * lines_.size();
  const auto product = [frames](const double* a, const double* b) {
    double lane[4] = {};
    std::size_t n = 0;
    for (; n + 4 <= frames; n += 4)
      for (std::size_t k = 0; k < 4; ++k) lane[k] += a[n + k] * b[n + k];
    double sum = lane[0] + lane[1] + lane[2] + lane[3];
    for (; n < frames; ++n) sum += a[n] * b[n];
    return sum;
  };
  double* gram = gram_.data() + pick_up * unknowns * unknowns;
  for (std::size_t i = 0; i < unknowns; ++i) {
    const double* column = columns_.data() + i * frames;
    for (std::size_t j = 0; j <= i; ++j)
      gram[i * unknowns + j] += product(column, columns_.data() + j * frames);
    right_[pick_up * unknowns + i] += product(column, block.row[pick_up]);
  }
  energy_[pick_up] += block.energy[pick_up];
}

void GlideProof::take(const AlignedBlock& block) {
  while (current_ < windows_.size() && windows_[current_].end <= block.first_frame) {
    ++current_;
    summed_ = 0;
  }
  if (current_ >= windows_.size() || windows_[current_].first > block.first_frame) return;
  Window& window = windows_[current_];
  if (block.first_frame == window.first) {
    for (auto* sums : {&gram_, &right_, &energy_, &planned_}) std::fill(sums->begin(), sums->end(), 0.0);
    summed_ = 0;
  }
  if (block.lost || block.first_frame != window.first + summed_) return;  // the window stays invalid
  fill_waves(block);
  for (std::size_t p = 0; p < pick_ups_; ++p) {
    fill_columns(p, block);
    add_products(p, block);
  }
  summed_ += block.frames;
  if (window.first + summed_ < window.end) return;
  for (std::size_t p = 0; p < pick_ups_; ++p) fit(p, window);
  window.valid = true;
}

double GlideProof::product(std::size_t pick_up, std::size_t i, std::size_t j) const noexcept {
  const std::size_t unknowns = 2 * lines_.size();
  return gram_[(pick_up * unknowns + std::max(i, j)) * unknowns + std::min(i, j)];
}

// The lines that are strong enough to be fitted, the strongest first.
std::vector<std::size_t> GlideProof::strong_lines(std::size_t pick_up) const {
  std::vector<std::size_t> lines(lines_.size());
  std::iota(lines.begin(), lines.end(), 0);
  const auto power = [&](std::size_t line) { return product(pick_up, 2 * line, 2 * line); };
  std::sort(lines.begin(), lines.end(), [&](auto a, auto b) { return power(a) > power(b); });
  const double least = kWeak * power(lines.front());
  std::erase_if(lines, [&](std::size_t line) { return !(power(line) > least); });
  return lines;
}

// Fits the strong lines of a window. The others are taken to be as planned, and subtracted.
void GlideProof::fit(std::size_t pick_up, Window& window) {
  auto lines = strong_lines(pick_up);
  const auto prepared = [&] {
    std::vector<double> matrix;
    for (std::size_t i = 0; i < 2 * lines.size(); ++i)
      for (std::size_t j = 0; j < 2 * lines.size(); ++j)
        matrix.push_back(product(pick_up, 2 * lines[i / 2] + i % 2, 2 * lines[j / 2] + j % 2));
    return joint_.prepare(matrix, lines.size());
  };
  while (!lines.empty() && !prepared()) lines.pop_back();  // two lines are too close to be told apart
  if (lines.empty()) return;
  Fit* fits = window.fits.data() + pick_up * lines_.size();
  const double* right = right_.data() + pick_up * 2 * lines_.size();
  for (const auto line : lines) fits[line].fitted = true;
  double energy = energy_[pick_up];
  for (std::size_t l = 0; l < lines_.size(); ++l)
    for (std::size_t m = 0; m < lines_.size() && !fits[l].fitted; ++m) {
      if (l == m) energy -= 2 * right[2 * l];
      if (!fits[m].fitted) energy += product(pick_up, 2 * l, 2 * m);
    }
  std::vector<std::complex<double>> sums, ratios(lines.size());
  for (const auto line : lines) {
    sums.emplace_back(right[2 * line], right[2 * line + 1]);
    for (std::size_t l = 0; l < lines_.size(); ++l)
      if (!fits[l].fitted)
        sums.back() -= std::complex(product(pick_up, 2 * line, 2 * l), product(pick_up, 2 * line + 1, 2 * l));
  }
  const double rest = joint_.solve(sums, energy, ratios) / static_cast<double>(window.end - window.first);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    Fit& fit = fits[lines[k]];
    const double power = product(pick_up, 2 * lines[k], 2 * lines[k]);
    fit.ratio = ratios[k];
    fit.error = std::sqrt(rest / power);
    if (const double best = lines_[lines[k]].best[pick_up]; best > 0)
      fit.seen = std::sqrt(2 * power / planned_[lines[k]]) / best;
  }
}

void GlideProof::end_at(std::int64_t frame) noexcept {
  while (!windows_.empty() && windows_.back().end > frame) windows_.pop_back();
  end_ = std::min(end_, frame);
}

bool GlideProof::failed() const noexcept {
  return !windows_.empty() &&
         std::none_of(windows_.begin(), windows_.end(), [](const Window& w) { return w.valid; });
}

// The fit of the pick-up that responds best to the line in this window; null if none can judge it.
const GlideProof::Fit* GlideProof::best_fit(const Window& window, std::size_t line,
                                            double unseen_dB) const noexcept {
  const Fit* best = nullptr;
  for (std::size_t p = 0; p < pick_ups_; ++p) {
    const Fit& fit = window.fits[p * lines_.size() + line];
    if (best == nullptr || fit.seen > best->seen) best = &fit;
  }
  const bool judged =
      best != nullptr && best->fitted && best->error < kUncertain && in_dB(best->seen) >= unseen_dB;
  return judged ? best : nullptr;
}

std::vector<GlideToneProof> GlideProof::result(double unseen_dB) const {
  std::vector<GlideToneProof> tones;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    GlideToneProof made;
    made.change = glide_.changes;
    const auto& first = lines_[l].tones.front();
    const auto hertz = [&](std::int64_t frame) {
      return static_cast<double>(tone_at(first, glide_.frames, frame).increment) * 0x1p-64 * rate_Hz_;
    };
    made.from_Hz = hertz(0);
    made.to_Hz = hertz(glide_.frames);
    std::complex<double> sum = 0;
    for (const Window& window : windows_) {
      const Fit* fit = window.valid ? best_fit(window, l, unseen_dB) : nullptr;
      if (fit == nullptr) continue;
      sum += fit->ratio;
      const double dB = in_dB(std::abs(fit->ratio));
      if (made.seen && std::fabs(dB) <= std::fabs(made.worst_ratio_dB)) continue;
      made.worst_ratio_dB = dB;
      made.pick_up = static_cast<int>(static_cast<std::size_t>(fit - window.fits.data()) / lines_.size());
      made.seen = true;
    }
    if (made.seen) made.phase_error_deg = std::arg(sum) * 180 / M_PI;
    for (const PlayedTone& tone : lines_[l].tones) {
      made.tone = tone.index;
      made.drive_channel = tone.partial.channel;
      tones.push_back(made);
    }
  }
  return tones;
}

}  // namespace turnpoint::sensing
