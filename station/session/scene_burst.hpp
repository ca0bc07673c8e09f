#pragma once
#include <string>

#include "station/drive/burst.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::session {

/// Plans one scene on its own, without a trial, a marker or a masking sound. Throws scene::Unreachable.
drive::Burst scene_burst(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                         const protocol::Factors& factors, double length_s);

}  // namespace turnpoint::session
