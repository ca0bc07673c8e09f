#pragma once
#include <map>
#include <string>

#include "station/text/problem.hpp"
#include "station/text/toml.hpp"

namespace turnpoint::protocol {

/// The place of each key in a protocol file: `task.correct.left`, `procedure.levels.values` (named tables are
/// listed by name), `task.choices.1` (others by number).
class KeyPlaces {
 public:
  KeyPlaces(const std::string& source, const std::string& path);
  KeyPlaces(const text::Value& document, const std::string& path);

  /// The place of the key. If the file does not contain it, the place of the table that would.
  text::Place of(std::string key) const;
  bool has(const std::string& key) const { return places_.count(key) > 0; }

 private:
  void add(const std::string& key, const text::Place& place, const text::Value& value);

  std::map<std::string, text::Place> places_;
};

}  // namespace turnpoint::protocol
