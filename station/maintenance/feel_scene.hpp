#pragma once
#include <stop_token>
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// What was played when somebody tried out a scene.
struct FeltScene {
  double length_s = 0;
  double rest_s = 0;  ///< how long the surface must then be still, by the rig's limits
  int tones = 0;
  double peak = 0;  ///< largest sample relative to full scale
};

/// Plays a scene of a protocol once, for as long as an interval of the task lasts, but for at most 5 s and
/// within the rig's limits. See play_on_rig(). `stop` ends it at once. Throws scene::Unreachable,
/// drive::BurstRefused, and the errors of play_armed().
FeltScene feel_scene(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                     const protocol::Factors& factors, const std::stop_token& stop);

}  // namespace turnpoint::maintenance
