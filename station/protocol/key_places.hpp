#pragma once
#include <map>
#include <string>

#include "station/core/problem.hpp"
#include "station/core/toml.hpp"

namespace turnpoint::protocol {

/// The line and column of each key in a protocol file. Each key has a path such as `task.correct.left`. A
/// table with a `name` is listed by this name (`procedure.levels.values`), other list items by number
/// (`task.choices.1`).
class KeyPlaces {
 public:
  KeyPlaces(const std::string& source, const std::string& path);
  KeyPlaces(const core::Value& document, const std::string& path);

  /// Returns the place of the key. If the file does not contain the key, returns the place of the table to
  /// which it belongs.
  core::Place of(std::string key) const;
  bool has(const std::string& key) const { return places_.count(key) > 0; }

 private:
  void add(const std::string& key, const core::Place& place, const core::Value& value);

  std::map<std::string, core::Place> places_;
};

}  // namespace turnpoint::protocol
