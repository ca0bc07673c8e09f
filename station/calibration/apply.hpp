#pragma once
#include <string>
#include <vector>

#include "station/calibration/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::calibration {

/// The rig as it was measured: each transducer's response and usable band (inside the rig's own), loss, and
/// friction, which then counts as measured. Boundaries are not moved by their fit: the fit says how far the
/// rig's geometry is from the truth, and the rig file is where that is put right.
/// Throws terms::UsageError for a transducer that the rig does not have, or that is left without a band.
rig::Rig applied(const Calibration& calibration, rig::Rig rig);

/// Where the newest calibration of a rig file lies: beside it, as `RIG.calibration-YYYY-MM-DD.toml`; "" where
/// there is none. file_for() is the name of one made on that day.
std::string newest_for(const std::string& rig_path);
std::string file_for(const std::string& rig_path, const std::string& date);

/// Today's date here, YYYY-MM-DD.
std::string today();

}  // namespace turnpoint::calibration
