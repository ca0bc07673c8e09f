#pragma once
#include <string>

#include "station/report/summary.hpp"

namespace turnpoint::report {

/// The confusion matrices of a report; "" if there are none.
std::string confusion_section(const Summary& summary);

/// The table of d', computed with each model in SessionData::deciding; "" if that list is empty.
std::string discrimination_section(const Summary& summary);

}  // namespace turnpoint::report
