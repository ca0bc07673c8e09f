#pragma once
#include <string>

#include "station/report/summary.hpp"

namespace turnpoint::report {

/// A single self-contained page: inline SVG, no script, no external files, laid out for the screen and for
/// A4.
std::string to_html(const Summary& summary);

/// The same numbers as one JSON document; missing values are null.
std::string to_json(const Summary& summary);

}  // namespace turnpoint::report
