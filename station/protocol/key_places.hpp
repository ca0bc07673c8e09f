#pragma once
#include <map>
#include <string>

#include "station/text/problem.hpp"
#include "station/text/toml.hpp"

namespace turnpoint::protocol {

/// Where each key of a protocol file stands: `task.correct.left`, `procedure.levels.values` (tables that have
/// a name go by it), `task.choices.1` (others by their number).
class KeyPlaces {
 public:
  KeyPlaces(const std::string& source, const std::string& path);
  KeyPlaces(const text::Value& document, const std::string& path);

  /// The place of the key or, where the file leaves it out, of the table that would hold it.
  text::Place of(std::string key) const;
  bool has(const std::string& key) const { return places_.count(key) > 0; }

 private:
  void add(const std::string& key, const text::Place& place, const text::Value& value);

  std::map<std::string, text::Place> places_;
};

}  // namespace turnpoint::protocol
