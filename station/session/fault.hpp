#pragma once
#include <string>

#include "station/terms/fault.hpp"

namespace turnpoint::session {

using terms::Fault;
using terms::FaultKind;
using terms::name;

/// A fault in words for whoever stands before the screen: what happened, what is safe, what to do.
struct FaultText {
  std::string happened, safe, to_do;
};

/// In the language asked for (two-letter code), or in English where the station does not speak it.
FaultText fault_text(FaultKind kind, const std::string& language);

}  // namespace turnpoint::session
