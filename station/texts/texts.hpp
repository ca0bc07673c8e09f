#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "station/terms/fault.hpp"

namespace turnpoint::texts {

/// Returns the two-letter codes of the languages that the station speaks, sorted.
std::vector<std::string> languages();

/// Returns all texts of the station in one of these languages, by key. The key of a text in a table has dots:
/// "fault.disk_full.happened".
const std::map<std::string, std::string, std::less<>>& catalogue(std::string_view language);

/// Says whether the station speaks a language ("de", "de-CH"), and whether a native speaker has read its
/// texts.
enum class Translation { none, unread, read };
Translation translation(const std::string& language);

/// Returns one text in the given language ("de", "de-CH"), or in English if the station does not speak that
/// language. Throws std::logic_error for a key that no catalogue has.
const std::string& text(std::string_view key, std::string_view language);

/// The explanation of a fault for the person in front of the screen: what happened, what is safe, what to do.
struct FaultText {
  std::string happened, safe, to_do;
};
FaultText fault_text(terms::FaultKind kind, const std::string& language);

}  // namespace turnpoint::texts
