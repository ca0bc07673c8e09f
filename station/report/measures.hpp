#pragma once
#include <optional>

#include "station/analysis/dependence.hpp"
#include "station/analysis/finger.hpp"
#include "station/analysis/followed.hpp"
#include "station/analysis/trade.hpp"

namespace turnpoint::report {

// What a report shows of each condition: declared once, for its tables and its JSON.

template <class Of>
struct Measure {
  const char* key;    ///< in JSON
  const char* title;  ///< of its row: the key of a text
  std::optional<analysis::Estimate> Of::*value;
  const char* name = "";  ///< in a study, and in differences between conditions; "" if it is in neither
  const char* unit = "";  ///< in a study
  bool compared = false;  ///< whether a session compares its conditions
  const char* part = "";  ///< the part of the report (shows()) to which it belongs; "" if every report has it
  bool brief = false;     ///< as in Cell
};

using Result = analysis::InstructionResult;
inline constexpr Measure<Result> kSpeedAndAccuracy[] = {
    {"proportion_correct", "report.proportion_right", &Result::proportion_correct, analysis::kCorrect, "",
     true, "", true},
    {"median_response_time_s", "figure.median_time", &Result::median_s, analysis::kMedianTime, "s", true, "",
     true},
    {"d_prime", "report.d_prime", &Result::d_prime, analysis::kSensitivity, "", true},
    {"boundary", "report.boundary", &Result::boundary, analysis::kBoundary, "s = 0.1", true, "ez"},
    {"nondecision_s", "report.nondecision", &Result::nondecision_s, analysis::kNondecision, "s", true, "ez"},
    {"drift", "report.drift", &Result::drift, analysis::kDrift, "s = 0.1", true, "ez"},
    {"contaminants", "report.contaminants", &Result::contaminants, "", "", false, "ez"},
    {"lisas_s", "report.lisas", &Result::lisas_s, analysis::kLisas, "s", true, "lisas"},
    {"inverse_efficiency_s", "report.inverse_efficiency", &Result::inverse_efficiency_s,
     analysis::kInverseEfficiency, "s", true, "ies"},
    {"points", "report.points", &Result::points, analysis::kPoints, "points", true, "points"},
    {"points_per_minute", "report.points_per_minute", &Result::points_per_minute, analysis::kPointsPerMinute,
     "points/min", true, "points"},
    {"post_error_slowing_s", "report.post_error", &Result::post_error_s, "post-error slowing", "s"},
    {"repetition", "report.repetition", &Result::repetition, "repetition of answers"},
    {"late_boundary", "report.late_boundary", &Result::late_boundary, "boundary, late minus early in a block",
     "s = 0.1", false, "ez"}};

using Touched = analysis::FingerCondition;
inline constexpr Measure<Touched> kFinger[] = {
    {"normal_N", "figure.normal_force", &Touched::normal_N, "", "", false, "", true},
    {"speed_mm_s", "figure.speed", &Touched::speed_mm_s, "", "", false, "", true},
    {"mu_low", "report.friction_smooth", &Touched::mu_low, "", "", false, "", true},
    {"mu_high", "report.friction_rough", &Touched::mu_high, "", "", false, "", true},
    {"felt_minus_planned_mm", "figure.felt", &Touched::shift_mm, "", "", false, "", true}};

using Following = analysis::FollowedCondition;
inline constexpr Measure<Following> kFollowing[] = {
    {"mu_asked", "report.mu_asked", &Following::mu_asked, "asked friction", "", false, "", true},
    {"mu_commanded", "report.mu_commanded", &Following::mu_commanded, "commanded friction"},
    {"mu_felt", "report.mu_felt", &Following::mu_felt, "felt friction", "", false, "", true},
    {"follow_lag_ms", "report.follow_lag", &Following::lag_ms, "lag of felt friction", "ms"},
    {"follow_inside", "report.follow_inside", &Following::inside, "felt friction within 10 %", "", false, "",
     true},
    {"follow_share", "report.follow_share", &Following::share, "time that follows the finger", "", false, "",
     true},
    {"envelope_error_dB", "report.envelope_error", &Following::envelope_error_dB, "error of the envelope",
     "dB"},
    {"envelope_lag_us", "report.envelope_lag", &Following::envelope_lag_us, "lag of the envelope", "us"}};

inline constexpr const char *kStimulusBefore = "effect of the stimulus before",
                            *kAnswerBefore = "effect of the answer before";

using Before = analysis::Dependence;
inline constexpr Measure<Before> kBefore[] = {
    {"stimulus", "report.present_stimulus", &Before::stimulus},
    {"previous_stimulus", "report.previous_stimulus", &Before::previous_stimulus, kStimulusBefore},
    {"previous_answer", "report.previous_answer", &Before::previous_answer, kAnswerBefore},
    {"after_error", "report.after_error", &Before::after_error}};

}  // namespace turnpoint::report
