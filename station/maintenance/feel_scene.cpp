#include "station/maintenance/feel_scene.hpp"

#include <algorithm>

#include "station/maintenance/play_armed.hpp"
#include "station/session/scene_burst.hpp"

namespace turnpoint::maintenance {

namespace {

constexpr double kLongest_s = 5, kUsual_s = 2, kShortestRest_s = 0.5;

}  // namespace

FeltScene feel_scene(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                     const protocol::Factors& factors, const std::stop_token& stop) {
  FeltScene felt;
  felt.length_s = std::min({protocol.task.duration_s.value_or(protocol.timing.explore_s.value_or(kUsual_s)),
                            kLongest_s, rig.limits.continuous_s});
  felt.rest_s = std::max(kShortestRest_s, felt.length_s * (1 / rig.limits.duty - 1));
  const auto burst = session::scene_burst(rig, protocol, scene, factors, felt.length_s);
  felt.tones = burst.tones.count;
  felt.peak = play_on_rig(rig, burst, stop).peak;
  return felt;
}

}  // namespace turnpoint::maintenance
