#pragma once
#include <string>
#include <vector>

#include "station/calibration/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::calibration {

/// The rig with its calibration applied: each transducer's response and usable band (within the rig's own),
/// loss, and friction, which then counts as measured. The fit of the boundaries is not applied. It shows how
/// far the rig file's geometry is from the truth, and should be corrected there. Throws terms::UsageError for
/// a transducer that the rig does not have, or that would be left without a band.
rig::Rig applied(const Calibration& calibration, rig::Rig rig);

/// newest_for() finds the newest calibration of a rig file: beside it, named
/// `RIG.calibration-YYYY-MM-DD.toml`; "" if there is none. file_for() is the name for a calibration of that
/// day.
std::string newest_for(const std::string& rig_path);
std::string file_for(const std::string& rig_path, const std::string& date);

/// Today's local date, YYYY-MM-DD.
std::string today();

}  // namespace turnpoint::calibration
