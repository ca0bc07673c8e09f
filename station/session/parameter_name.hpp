#pragma once
#include <string>

#include "station/texts/texts.hpp"

namespace turnpoint::session {

/// How pages call an estimated parameter, such as "threshold". A parameter of a separate program keeps the
/// name that the program gives it.
texts::Phrase parameter_name(const std::string& parameter);

}  // namespace turnpoint::session
