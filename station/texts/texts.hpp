#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/terms/fault.hpp"

namespace turnpoint::texts {

/// The languages that the station speaks: two-letter codes, sorted.
std::vector<std::string> languages();

/// What the station says, by key, in one of these languages. The keys of a table are joined by dots:
/// "fault.disk_full.happened".
const std::map<std::string, std::string>& catalogue(const std::string& language);

/// One text in the language asked for ("de", "de-CH"), or in English where the station does not speak that
/// language. Throws std::logic_error for a key that no catalogue has.
const std::string& text(const std::string& key, const std::string& language);

/// A fault in words for whoever stands before the screen: what happened, what is safe, what to do.
struct FaultText {
  std::string happened, safe, to_do;
};
FaultText fault_text(terms::FaultKind kind, const std::string& language);

}  // namespace turnpoint::texts
