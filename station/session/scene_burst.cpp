#include "station/session/scene_burst.hpp"

#include "station/protocol/resolve.hpp"
#include "station/scene/planner.hpp"
#include "station/session/burst.hpp"

namespace turnpoint::session {

drive::Burst scene_burst(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                         const protocol::Factors& factors, double length_s) {
  scene::Planner planner(rig);
  const auto plan = planner.plan(protocol::resolve(protocol, scene, factors, 0));
  return burst_of({plan}, {}, {}, length_s, rig.output.rate_Hz);
}

}  // namespace turnpoint::session
