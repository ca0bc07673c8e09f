#pragma once
#include <string>

#include "station/report/summary.hpp"

namespace turnpoint::report {

/// Returns the report as one self-contained page, laid out for the screen and for A4 paper: inline SVG, no
/// script, no external files.
std::string to_html(const Summary& summary);

/// Returns the content of the report as one JSON document. Missing values are null.
std::string to_json(const Summary& summary);

}  // namespace turnpoint::report
