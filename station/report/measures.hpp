#pragma once
#include <optional>

#include "station/analysis/finger.hpp"
#include "station/analysis/trade.hpp"

namespace turnpoint::report {

// What a report shows of each condition: declared once, for its tables and its JSON.

template <class Of>
struct Measure {
  const char* key;    ///< in JSON
  const char* title;  ///< of its row: the key of a text
  std::optional<analysis::Estimate> Of::*value;
  const char* difference = "";  ///< the name of its difference between conditions; "" if it has none
  const char* part = "";  ///< the part of the report (shows()) to which it belongs; "" if every report has it
  bool brief = false;     ///< as in Cell
};

using Result = analysis::InstructionResult;
inline constexpr Measure<Result> kSpeedAndAccuracy[] = {
    {"proportion_correct", "report.proportion_right", &Result::proportion_correct, "proportion correct", "",
     true},
    {"median_response_time_s", "figure.median_time", &Result::median_s, "median response time", "", true},
    {"d_prime", "report.d_prime", &Result::d_prime, "d'"},
    {"boundary", "report.boundary", &Result::boundary, "boundary", "ez"},
    {"nondecision_s", "report.nondecision", &Result::nondecision_s, "time outside the decision", "ez"},
    {"drift", "report.drift", &Result::drift, "drift", "ez"},
    {"contaminants", "report.contaminants", &Result::contaminants, "", "ez"},
    {"lisas_s", "report.lisas", &Result::lisas_s, "LISAS", "lisas"},
    {"inverse_efficiency_s", "report.inverse_efficiency", &Result::inverse_efficiency_s, "inverse efficiency",
     "ies"},
    {"points", "report.points", &Result::points, "points a trial", "points"},
    {"points_per_minute", "report.points_per_minute", &Result::points_per_minute,
     "points a minute", "points"},
    {"post_error_slowing_s", "report.post_error", &Result::post_error_s},
    {"repetition", "report.repetition",
     &Result::repetition},
    {"late_boundary", "report.late_boundary",
     &Result::late_boundary, "", "ez"}};

using Touched = analysis::FingerCondition;
inline constexpr Measure<Touched> kFinger[] = {
    {"normal_N", "figure.normal_force", &Touched::normal_N, "", "", true},
    {"speed_mm_s", "figure.speed", &Touched::speed_mm_s, "", "", true},
    {"mu_low", "report.friction_smooth", &Touched::mu_low, "", "", true},
    {"mu_high", "report.friction_rough", &Touched::mu_high, "", "", true},
    {"felt_minus_planned_mm", "figure.felt", &Touched::shift_mm, "", "", true}};

}  // namespace turnpoint::report
