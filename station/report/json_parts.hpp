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
inline Json value(const std::optional<double>& number) { return number ? value(*number) : Json(nullptr); }
inline Json value(const analysis::Interval& i) { return {{"low", value(i.low)}, {"high", value(i.high)}}; }

inline Json value(const std::optional<analysis::Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", value(estimate->value)}, {"interval", value(estimate->interval)}};
}

inline Json value(const std::optional<analysis::ParameterInterval>& interval) {
  if (!interval) return nullptr;
  return {{"low", value(interval->interval.low)},
          {"high", value(interval->interval.high)},
          {"touches_low", interval->touches_low},
          {"touches_high", interval->touches_high}};
}

inline Json value(const ProcedureEstimate& estimate) {
  return {{"procedure", estimate.procedure},
          {"block", estimate.block},
          {"parameter", estimate.parameter},
          {"mean", value(estimate.mean)},
          {"sd", value(estimate.sd)},
          {"interval", estimate.interval ? value(*estimate.interval) : Json(nullptr)},
          {"unit", estimate.unit},
          {"basis", estimate.basis}};
}

inline Json value(const EarlyEnd& end) {
  return {{"block", end.block}, {"procedure", end.procedure}, {"reason", core::say(end.why, "en")}};
}

inline Json value(const std::vector<analysis::Statement>& statements) {
  Json list = Json::array();
  for (const auto& statement : statements)
    list.push_back({{"code", statement.code}, {"text", core::say(statement.text, "en")}});
  return list;
}

/// What each analysis measures, as the protocol decides it.
inline Json meanings_json(const SessionData& data) {
  Json list = Json::array();
  const auto add = [&list](const LevelAnalysis& part) {
    list.push_back(
        {{"analysis", part.name.empty() ? Json(nullptr) : Json(part.name)}, {"measures", part.meaning}});
  };
  for (const auto& part : data.parts) add(part);
  if (data.parts.empty()) add(data);
  return list;
}

}  // namespace turnpoint::report
