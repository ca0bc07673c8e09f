#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "station/audio/prepared_burst.hpp"
#include "station/sensing/pick_up.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

/// One tone of a Stretch or of a Glide.
struct PlayedTone {
  int index = 0;  ///< index in the burst's tone set
  /// the tone from the stretch's origin_frame, or from the glide's first frame
  audio::Partial partial;
};

/// A stretch is a part of a burst, between ramps and changes, in which frequencies and amplitudes are
/// constant.
struct Stretch {
  int changes = 0;                              ///< number of changes that come before it
  std::int64_t origin_frame = 0;                ///< absolute frame that is frame 0 of the tones
  std::int64_t first_frame = 0, end_frame = 0;  ///< absolute frames: the first, and the one after the last
  std::vector<PlayedTone> tones;                ///< tones of amplitude 0 are left out
};

/// A glide is a change of a burst, from the tones of one stretch to those of the next.
struct Glide {
  int changes = 0;               ///< number of this change, from 1
  std::int64_t first_frame = 0;  ///< absolute frame
  std::int64_t frames = 1;
  std::vector<PlayedTone> tones;  ///< tones that are silent before and after are left out
};

/// Follows the tones of a burst from change to change, as the synthesiser plays them.
class PlannedTones {
 public:
  explicit PlannedTones(const audio::PreparedBurst& burst);

  /// Applies a change, and returns it as a glide. The changes of a burst must be applied in order.
  Glide change(const audio::PreparedChange& change);
  /// The stretch from the last change on, limited to these absolute frames.
  Stretch stretch(std::int64_t first_frame, std::int64_t end_frame) const;
  /// The absolute frame at which the last change has ended, or at which the burst begins.
  std::int64_t origin_frame() const { return start_frame_ + origin_; }

 private:
  std::vector<audio::Partial> tones_;  // their frame 0 is origin_
  std::int64_t start_frame_, origin_ = 0;
  int changes_ = 0;
};

/// Returns the stretches of a burst as the synthesiser plays it. Changes that are sent while the burst plays
/// are not included.
std::vector<Stretch> planned_stretches(const audio::PreparedBurst& burst);

/// All tones with the same frequency in one steady part of a burst. Only their sum can be measured.
struct PlannedLine {
  double frequency_Hz = 0;
  double gain = 1;  ///< gain of the high-pass filter at this frequency (high_pass_gain())
  std::vector<PlayedTone> tones;
  /// The complex amplitude that each pick-up should capture, relative to the phase of the first tone and
  /// before the high-pass filter.
  std::vector<std::complex<double>> expected;
  /// each pick-up's response as a fraction of its largest response; 0 if not calibrated
  std::vector<double> seen;
};

std::vector<PlannedLine> planned_lines(const Stretch& stretch, const std::vector<PickUp>& pick_ups,
                                       int rate_Hz);

/// Returns the index of the pick-up that captures these lines (tones) most strongly. `pick_ups` is the number
/// of pick-ups.
std::size_t main_pick_up(const std::vector<PlannedLine>& lines, std::size_t pick_ups);

/// Returns the mean square of the samples that a pick-up should capture if all lines play as planned, after
/// the high-pass filter.
double planned_power(const std::vector<PlannedLine>& lines, std::size_t pick_up);

/// Converts a ratio of amplitudes to dB; the result is at least -200.
inline double in_dB(double ratio) { return 20 * std::log10(std::max(ratio, 1e-10)); }

}  // namespace turnpoint::sensing
