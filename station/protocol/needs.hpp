#pragma once
#include "station/protocol/protocol.hpp"
#include "station/protocol/survey.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::protocol {

/// Adds to the survey's problems what the protocol needs and the rig does not have: devices for answers,
/// sounds and contact, trigger outputs, sensors, and force cells for friction tables.
void check_needs(const Protocol& protocol, const rig::Rig& rig, Survey& survey);

}  // namespace turnpoint::protocol
