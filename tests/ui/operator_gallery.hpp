#pragma once
#include <string>

#include "station/desk/live_view.hpp"
#include "station/desk/report_pages.hpp"

namespace turnpoint::ui {

/// Returns what an operator would see after `trials` trials of a session with a simulated observer.
desk::LiveState live_exhibit(const std::string& protocol, int trials);

/// Returns the report of a whole simulated session of that protocol.
desk::ReportPages report_exhibit(const std::string& protocol);
/// Returns the same report as if force cells had recorded; their values are invented.
desk::ReportPages forces_exhibit(const std::string& protocol);

/// Creates a database in `folder` with an interrupted session of participant P03. Returns its path.
std::string interrupted_exhibit(const std::string& folder);

/// Creates a database in `folder` in which participant P01 had the first session of friction-training today.
/// Returns its path.
std::string today_exhibit(const std::string& folder);

}  // namespace turnpoint::ui
