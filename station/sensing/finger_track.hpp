#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/sensing/force_calibration.hpp"

namespace turnpoint::sensing {

/// Position and speed are known only above this normal force.
inline constexpr double least_normal_N = 0.1;

/// The finger at one point of the grid.
struct FingerPoint {
  std::int64_t index = 0;
  double normal_N = 0, lateral_N = 0;  ///< as they came, in the band of the bridges
  /// From the wide edge, and towards larger positions. Both are NaN without contact, below least_normal_N,
  /// and within 40 ms of missing points.
  double position_mm = 0, speed_mm_s = 0;
  bool contact = false;
};

/// Turns forces into the track of the finger. Position and speed are those of the straight line that fits the
/// positions moment / normal force best around the point, with Gaussian weights in time and weights of the
/// squared force (a position is the more precise the harder the finger presses). This is a low-pass at 20 Hz
/// (half the amplitude, no ringing) and its derivative, which a change of force during the movement does not
/// bias. Contact begins with the first of 20 ms above 0.05 N, and ends below 0.03 N. Points come 40 ms late.
/// Allocates only in the constructor.
class FingerTracker {
 public:
  explicit FingerTracker(Band band = Band::force);

  /// Takes the next point of the grid. Returns the point in the middle of the window; empty while the window
  /// is not yet full. Throws std::logic_error if a point of the grid was left out.
  std::optional<FingerPoint> push(const ForcePoint& point);

 private:
  struct Entry {
    ForcePoint point;
    bool contact = false;
  };
  /// The point `ago` points before the newest.
  Entry& at(std::int64_t ago);
  void judge_contact();

  std::vector<double> weights_;  ///< by distance from the middle, 0 ... half, in points
  std::vector<Entry> ring_;
  std::int64_t count_ = 0, above_ = 0, points_for_contact_;
  double rate_Hz_;
};

/// The track of a whole recording.
std::vector<FingerPoint> finger_track(const std::vector<ForcePoint>& forces, Band band = Band::force);

}  // namespace turnpoint::sensing
