#pragma once
#include <functional>
#include <stop_token>
#include <string>

#include "station/rehearsal/check.hpp"

namespace turnpoint::ui {

/// A function that checks a protocol file with a rig file, like rehearsal::check().
using Checker = std::function<rehearsal::Check(const std::string& protocol, const std::string& rig,
                                               const std::stop_token& stop)>;

/// Checks a protocol as `turnpoint check` does, with the rig's calibration and with few simulated sessions,
/// so that a page can show the result soon.
rehearsal::Check check_protocol(const std::string& protocol, const std::string& rig,
                                const std::stop_token& stop);

/// A function that checks the text of a protocol, which need not be saved. Messages name `path` as the file.
using SourceChecker = std::function<rehearsal::Check(const std::string& source, const std::string& path,
                                                     const std::string& rig, const std::stop_token& stop)>;
rehearsal::Check check_source(const std::string& source, const std::string& path, const std::string& rig,
                              const std::stop_token& stop);

}  // namespace turnpoint::ui
