#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/psychometric_fit.hpp"
#include "station/report/study.hpp"

namespace turnpoint::report {

// Functions that convert numbers and intervals to JSON. JSON has no NaN and no infinity; both become null.

using Json = nlohmann::ordered_json;

/// The report of a study. Its tables in CSV are those of this document.
Json json_of(const Study& study);

inline Json value(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }
inline Json value(const analysis::Interval& i) { return {{"low", value(i.low)}, {"high", value(i.high)}}; }

inline Json value(const analysis::Estimate& estimate) {
  return {{"value", value(estimate.value)}, {"interval", value(estimate.interval)}};
}

inline Json value(const analysis::ParameterInterval& interval) {
  return {{"low", value(interval.interval.low)},
          {"high", value(interval.interval.high)},
          {"touches_low", interval.touches_low},
          {"touches_high", interval.touches_high}};
}

template <class Value>
Json value(const std::optional<Value>& some) {
  return some ? value(*some) : Json(nullptr);
}

/// A list of what `json_of` says of each.
template <class All, class Of>
Json list_of(const All& all, const Of& json_of) {
  Json list = Json::array();
  for (const auto& one : all) list.push_back(json_of(one));
  return list;
}

inline Json value(const ProcedureEstimate& estimate) {
  return {{"procedure", estimate.procedure}, {"block", estimate.block},
          {"parameter", estimate.parameter}, {"mean", value(estimate.mean)},
          {"sd", value(estimate.sd)},        {"interval", value(estimate.interval)},
          {"unit", estimate.unit},           {"basis", estimate.basis}};
}

inline Json value(const EarlyEnd& end) {
  return {{"block", end.block}, {"procedure", end.procedure}, {"reason", core::say(end.why, "en")}};
}

inline Json value(const analysis::Statement& statement) {
  return {{"code", statement.code}, {"text", core::say(statement.text, "en")}};
}

inline Json value(const std::vector<analysis::Statement>& statements) {
  return list_of(statements, [](const auto& one) { return value(one); });
}

/// What each analysis measures, as the protocol decides it.
inline Json meanings_json(const SessionData& data) {
  const auto json_of = [](const LevelAnalysis& part) -> Json {
    return {{"analysis", part.name.empty() ? Json(nullptr) : Json(part.name)}, {"measures", part.meaning}};
  };
  if (data.parts.empty()) return Json::array({json_of(data)});
  return list_of(data.parts, json_of);
}

}  // namespace turnpoint::report
