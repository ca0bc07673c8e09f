#pragma once
#include <complex>
#include <cstdint>
#include <vector>

#include "station/sensing/pick_up.hpp"
#include "station/sensing/planned_stretches.hpp"

namespace turnpoint::sensing {

/// The tone at a frame counted from the first frame of its glide of `frames` frames. Before and after the
/// glide its frequency is constant.
drive::Partial tone_at(const GlidingTone& tone, std::int64_t frames, std::int64_t frame) noexcept;

/// What a pick-up captures of a tone that glides. A tone that passes a resonance in a few milliseconds is
/// neither as strong nor as late as a steady tone of the same frequency. So the tone is filtered with the
/// pick-up's calibrated response, in the frequency domain, at a reduced sampling rate.
class GlideResponse {
 public:
  /// Computes the response until `tail_frames` after the end of the glide.
  GlideResponse(const Glide& glide, const GlidingTone& tone, const PickUp& pick_up, int rate_Hz,
                std::int64_t tail_frames);

  /// False if the calibration does not cover the whole glide; at() is then 0.
  bool calibrated() const noexcept { return !values_.empty(); }
  /// The captured complex amplitude relative to the phase with which the tone is played, at this frame
  /// (counted from the glide's first frame; may have a fraction) and without the loop delay.
  std::complex<double> at(double frame) const noexcept;

 private:
  std::int64_t lead_ = 0, step_ = 1;  ///< value k belongs to frame k * step_ - lead_
  std::vector<std::complex<double>> values_;
};

}  // namespace turnpoint::sensing
