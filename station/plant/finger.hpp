#pragma once
#include <cstdint>

#include "physics/friction.hpp"
#include "station/plant/noise.hpp"
#include "station/plant/setup.hpp"

namespace turnpoint::plant {

/// Distance covered by a movement of minimum jerk, from 0 to 1, at a share 0 ... 1 of its duration; and its
/// speed per duration, at most 1.875 (Flash & Hogan 1985).
double minimum_jerk(double share);
double minimum_jerk_speed(double share);

/// What the finger does at one moment.
struct FingerState {
  double finger_m = 0;   ///< the finger's bone
  double contact_m = 0;  ///< the skin that touches: it stays behind the bone by the stretch
  double speed_m_s = 0;  ///< of the bone
  double normal_N = 0,
         lateral_N = 0;          ///< lateral: positive towards the tip, as the finger moves when x grows
  double friction = 0;           ///< coefficient now; lateral_N is friction * normal_N while the skin slides
  double relative_friction = 1;  ///< what the vibration leaves of it
};

/// The finger, in equal steps of time.
class FingerModel {
 public:
  FingerModel(const Finger& finger, const physics::FrictionMap& map, double step_s, int frames_per_step,
              std::uint64_t seed);

  /// Where the finger touches before the next step; the amplitude is to be taken there.
  double contact_m() const { return state_.contact_m; }
  /// Goes to the step that begins at this captured frame. `amplitude_m`: of the surface at the contact.
  const FingerState& step(std::int64_t frame, double amplitude_m, bool lifted);

 private:
  void move(std::int64_t frame);
  bool scheduled(std::int64_t frame);

  Finger finger_;
  physics::FrictionMap map_;
  double step_s_;
  double rate_Hz_;
  double film_;
  PinkNoise normal_noise_, friction_noise_;
  std::int64_t steps_ = 0;
  std::size_t touch_ = 0;
  double pressed_ = 0;  // 0 ... 1: how much of the normal force has built up
  double stretch_m_ = 0;
  FingerState state_;
};

}  // namespace turnpoint::plant
