#pragma once
#include <string>

#include "station/report/summary.hpp"

namespace turnpoint::report {

/// One self-contained page: inline SVG, no script, nothing fetched, laid out for the screen and for A4.
std::string to_html(const Summary& summary);

/// The same numbers as one JSON document; what is not there is null.
std::string to_json(const Summary& summary);

}  // namespace turnpoint::report
