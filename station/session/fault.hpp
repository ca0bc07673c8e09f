#pragma once
#include <string>

#include "station/terms/fault.hpp"

namespace turnpoint::session {

using terms::Fault;
using terms::FaultKind;
using terms::name;

/// A fault in words for the people at the screen: what happened, what is safe, what to do.
struct FaultText {
  std::string happened, safe, to_do;
};

/// The text in this language (two-letter code), or in English if the station does not have the language.
FaultText fault_text(FaultKind kind, const std::string& language);

}  // namespace turnpoint::session
