#pragma once
#include <string>
#include <vector>

#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// Returns the rig with the values of the calibration: each transducer's response, and its usable band as far
/// as it lies within the rig's band; loss; the surface that measured boundaries determine; the responses of
/// the pick-ups; the levels of the mixer; and friction, which then counts as measured. Throws
/// core::UsageError for a transducer or a pick-up that the rig does not have, or a transducer that would be
/// left without a band.
Rig applied(const Calibration& calibration, Rig rig);

/// newest_for() returns the newest file named `RIG.calibration-YYYY-MM-DD.toml` beside the rig file; "" if
/// there is none. file_for() returns the name of such a file for a date.
std::string newest_for(const std::string& rig_path);
std::string file_for(const std::string& rig_path, const std::string& date);

/// Today's local date, YYYY-MM-DD.
std::string today();

}  // namespace turnpoint::rig
