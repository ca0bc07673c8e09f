#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "station/sensing/force_calibration.hpp"

namespace turnpoint::sensing {

/// Below this normal force, position and speed are too uncertain to be given (they are NaN).
inline constexpr double least_normal_N = 0.1;
/// Contact begins when the normal force has been above contact_N for contact_s.
inline constexpr double contact_N = 0.05, contact_s = 0.02;

/// The finger at one point in time; `index` is the index of the ForcePoint from which it was computed.
struct FingerPoint {
  std::int64_t index = 0;
  double normal_N = 0, lateral_N = 0;  ///< the measured forces, without further filtering
  /// Position counts from the wide edge, and speed is positive towards larger positions. Both are NaN if the
  /// normal force is below least_normal_N, and within 38 ms of missing points and of points without contact:
  /// the cells still ring when a finger has just landed or left.
  double position_mm = 0, speed_mm_s = 0;
  bool contact = false;
};

/// Turns force points into the finger's position and speed over time. Around each point in time, it fits a
/// straight line to the positions (moment / normal force), which gives position and speed. The weights are
/// Gaussian in time, times the squared normal force, because a position is more precise if the finger presses
/// harder. For the position, the fit acts as a low-pass filter without ringing, which halves the amplitude at
/// 20 Hz; for the speed, as the derivative of that filter. A change of force during the movement causes no
/// bias.
///
/// Contact begins at the first point of a run of 20 ms above 0.05 N, and ends when the force falls below 0.03
/// N. Results come 38 ms late. Allocates only in the constructor.
class FingerTracker {
 public:
  explicit FingerTracker(Band band = Band::force);

  /// Takes the next point. Returns the finger at the middle of the window; empty until the window is full.
  /// Throws std::logic_error if a point was left out.
  std::optional<FingerPoint> push(const ForcePoint& point);

 private:
  struct Entry {
    ForcePoint point;
    bool contact = false;
  };
  /// The point that came `ago` points before the newest.
  Entry& at(std::int64_t ago);
  void judge_contact();

  std::vector<double> weights_;  ///< weights_[k]: Gaussian weight of a point k points from the middle
  std::vector<Entry> ring_;
  std::int64_t count_ = 0, above_ = 0, points_for_contact_;
  double rate_Hz_;
};

/// Computes the finger's position and speed over a whole recording.
std::vector<FingerPoint> finger_track(const std::vector<ForcePoint>& forces, Band band = Band::force);

/// A movement of the finger in one direction, as a range of indices into the track of the finger.
struct Stroke {
  /// the points of the stroke except 5 mm at each end, where the direction of the skin's deflection changes
  std::size_t first = 0, end = 0;
  int direction = 0;  ///< 1 towards larger positions, -1 towards smaller positions
};

/// Finds the strokes in a track. A stroke is faster than 10 mm/s without interruption, and at least 30 mm
/// long including its ends.
std::vector<Stroke> find_strokes(std::span<const FingerPoint> track);

}  // namespace turnpoint::sensing
