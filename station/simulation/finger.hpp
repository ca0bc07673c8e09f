#pragma once
#include <cstdint>

#include "station/simulation/noise.hpp"
#include "station/simulation/setup.hpp"

namespace turnpoint::simulation {

/// Distance and speed of a movement of minimum jerk (Flash & Hogan 1985), after the fraction `share` of its
/// duration. The distance goes from 0 to 1; the speed is relative to the mean speed, and at most 1.875.
double minimum_jerk(double share);
double minimum_jerk_speed(double share);

/// What the finger does at one moment.
struct FingerState {
  double finger_m = 0;   ///< position of the finger's bone
  double contact_m = 0;  ///< position of the touching skin; stretched skin stays behind the bone
  double speed_m_s = 0;  ///< speed of the bone
  double normal_N = 0,
         lateral_N = 0;  ///< lateral_N is positive towards larger x
  /// current coefficient of friction: lateral_N / normal_N while the skin slides
  double friction = 0;
  double relative_friction = 1;  ///< factor by which the vibration reduces friction
};

/// Simulates the finger in equal time steps.
class FingerModel {
 public:
  FingerModel(const Finger& finger, double step_s, int frames_per_step, std::uint64_t seed);

  /// Replaces all touches by this one. Its frame numbers are counted like those of step().
  void touch(const Touch& touch);
  /// Ends every touch at this frame at the latest.
  void lift(std::int64_t frame);
  /// From now on, force and friction no longer vary at random.
  void steady() { finger_.normal_noise = finger_.friction_noise = 0; }
  /// Position at which the finger will touch in the next step. step() needs the friction there.
  double contact_m() const { return state_.contact_m; }
  /// Advances to the step that begins at audio frame `frame`. `relative_friction` is the factor
  /// by which a steady vibration reduces friction at contact_m(); the air film follows it with a lag.
  const FingerState& step(std::int64_t frame, double relative_friction, bool lifted);

 private:
  void move(std::int64_t frame);
  bool scheduled(std::int64_t frame);

  Finger finger_;
  double step_s_;
  double rate_Hz_;
  double film_;
  PinkNoise normal_noise_, friction_noise_;
  std::int64_t steps_ = 0;
  std::size_t touch_ = 0;
  double pressed_ = 0;  // how far the finger has landed: 0 in the air, 1 with its full force
  double stretch_m_ = 0;
  FingerState state_;
};

}  // namespace turnpoint::simulation
