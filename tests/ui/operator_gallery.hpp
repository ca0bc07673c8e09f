#pragma once
#include <string>

#include "station/view/live_view.hpp"
#include "station/view/report_pages.hpp"

namespace turnpoint::ui {

// Texts and figures are in a language such as "de".

/// Returns what an operator would see after `trials` trials of a session with a simulated observer.
view::LiveState live_exhibit(const std::string& protocol, int trials, const std::string& language);

/// Returns the report of a whole simulated session of that protocol.
view::ReportPages report_exhibit(const std::string& protocol, const std::string& language);
/// Returns the same report as if force cells had recorded; their values are invented.
view::ReportPages forces_exhibit(const std::string& protocol, const std::string& language);

/// Creates a database in `folder` with an interrupted session of participant P03. Returns its path.
std::string interrupted_exhibit(const std::string& folder);

/// Creates a database in `folder` in which participant P01 had the first session of friction-training today.
/// Returns its path.
std::string today_exhibit(const std::string& folder);

}  // namespace turnpoint::ui
