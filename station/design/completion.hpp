#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "station/design/schema.hpp"

namespace turnpoint::design {

/// One way to continue at the cursor.
struct Suggestion {
  std::string word;    ///< the key, the value, or the table, as it is shown
  std::string insert;  ///< what replaces the text from `Completion::from` to the cursor
  std::string help;    ///< what the schema says about it; may be ""
};

/// What can be written at a place of a protocol file.
struct Completion {
  std::size_t from = 0;  ///< offset of the begun word, in bytes
  std::vector<Suggestion> suggestions;
};

/// Suggests tables, keys and values at the offset `at`: those that the schema allows there, and names that
/// the file defines. Only what begins with the word before the cursor is suggested, and no key that its table
/// already has. The text need not be valid TOML.
Completion complete(const Schema& schema, std::string_view text, std::size_t at);

}  // namespace turnpoint::design
