#include "station/sensing/glide_response.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "station/drive/ramp.hpp"

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
  return {drive::sine_of_phase(phase + drive::quarter_cycle), drive::sine_of_phase(phase)};
}

const Transfer* calibration_of(const PickUp& pick_up, int channel) {
  for (const Transfer& transfer : pick_up.transfers)
    if (transfer.drive_channel == channel) return &transfer;
  return nullptr;
}

}  // namespace

drive::Partial tone_at(const GlidingTone& tone, std::int64_t frames, std::int64_t frame) noexcept {
  drive::Partial partial = tone.partial;
  const std::int64_t gliding = std::clamp<std::int64_t>(frame, 0, frames);
  partial = drive::advanced(partial, static_cast<std::uint64_t>(gliding));
  partial.amplitude += partial.amplitude_change * (frame < 0 ? 0 : drive::ramp_at(frame, frames));
  if (frame == gliding) return partial;
  partial.phase += partial.increment * static_cast<std::uint64_t>(frame - gliding);
  partial.curvature = 0;
  return partial;
}

GlideResponse::GlideResponse(const Glide& glide, const GlidingTone& tone, const PickUp& pick_up, int rate_Hz,
                             std::int64_t tail_frames) {
  const auto hertz = [rate_Hz](std::uint64_t increment) {
    return static_cast<double>(static_cast<std::int64_t>(increment)) * 0x1p-64 * rate_Hz;
  };
  const std::uint64_t from = tone.partial.increment, to = tone_at(tone, glide.frames, glide.frames).increment;
  if (!response(pick_up, tone.channel, hertz(from)) || !response(pick_up, tone.channel, hertz(to))) return;
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
    const drive::Partial now = tone_at(tone, glide.frames, frame);
    turn[k] = turned(now.phase - middle * static_cast<std::uint64_t>(frame));
    values_[k] = now.amplitude * turn[k];
  }
  const Transfer& calibrated = *calibration_of(pick_up, tone.channel);
  const double low_Hz = calibrated.frequency_Hz.front(), high_Hz = calibrated.frequency_Hz.back();
  const auto count = static_cast<double>(values_.size());
  Eigen::FFT<double> transform;
  std::vector<Amplitude> spectrum;
  transform.fwd(spectrum, values_);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double place = static_cast<double>(k) - (2 * k < values_.size() ? 0 : count);
    const double frequency_Hz = hertz(middle) + place / count * rate_Hz / static_cast<double>(step_);
    spectrum[k] *= *response(pick_up, tone.channel, std::clamp(frequency_Hz, low_Hz, high_Hz));
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

}  // namespace turnpoint::sensing
