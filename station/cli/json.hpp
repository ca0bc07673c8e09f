#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

#include "physics/warning.hpp"

namespace turnpoint::cli {

/// JSON whose keys keep the order in which they were written.
using Json = nlohmann::ordered_json;

/// How dump() writes bytes that are not UTF-8, as a path may have: as U+FFFD. A document with them would be
/// refused otherwise, after the work has been done.
inline constexpr auto kInvalidBytes = Json::error_handler_t::replace;

/// Writes the result of a command as one document.
inline void print_json(std::ostream& out, const Json& json) {
  out << json.dump(2, ' ', false, kInvalidBytes) << "\n";
}

/// JSON has no NaN and no infinity; they become null.
inline Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// The value times `factor`, which converts its unit; null if there is no value.
inline Json json_number(const std::optional<double>& value, double factor = 1) {
  return value ? json_number(*value * factor) : Json(nullptr);
}

/// The ends of an interval, or null.
inline Json json_interval(const std::optional<std::pair<double, double>>& interval) {
  if (!interval) return nullptr;
  return {{"low", json_number(interval->first)}, {"high", json_number(interval->second)}};
}

inline Json json_numbers(const std::vector<double>& values, double factor = 1) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_number(value * factor));
  return list;
}

inline Json json_warnings(const std::vector<physics::Warning>& warnings) {
  Json list = Json::array();
  for (const auto& warning : warnings) list.push_back({{"code", warning.code}, {"text", warning.text}});
  return list;
}

}  // namespace turnpoint::cli
