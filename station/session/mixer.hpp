#pragma once
#include <map>
#include <string>

#include "station/rig/rig.hpp"
#include "station/session/self_test.hpp"

namespace turnpoint::session {

/// Reads the mixers of the cards with which a rig plays and captures (drive::mixer_levels). Controls of
/// another card that captures have "capture: " before their names. Empty if there is no card or it cannot be
/// read.
std::map<std::string, std::string> mixer_levels(const rig::Rig& rig);

/// Compares the mixers with their levels during the calibration (`rig.mixer`).
MixerReading read_mixer(const rig::Rig& rig);

}  // namespace turnpoint::session
