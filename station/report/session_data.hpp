#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
#include "station/analysis/speed_accuracy.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::report {

/// How answers relate to levels, which decides what is fitted.
enum class Design {
  forced_choice,   ///< correctness rises with the level; guess = 1 / alternatives
  two_sided,       ///< two answers on a signed level: PSE and spread, never scored as forced choice
  yes_no,          ///< "yes" rises with the size of the level; trials at 0 are noise
  same_different,  ///< the same with "different" and pairs that are the same
  adjustment,      ///< no psychometric function
};

/// Whether some trials have no signal, so that "yes" there is a false alarm.
inline bool has_noise(Design design) { return design == Design::yes_no || design == Design::same_different; }

/// What a track of levels came to; `basis` says what the estimate is taken from.
struct StaircaseResult {
  std::string block, procedure;
  double mean = 0;           ///< in the unit of the level
  std::optional<double> sd;  ///< of the reversals that were averaged
  std::string basis;
};

/// A named fact for the head or the health table of a report, already in words.
using Fact = std::pair<std::string, std::string>;

/// All that a report is made of; filled from a database by the application layer.
struct SessionData {
  std::string title;  ///< of the protocol
  std::string participant, session_id, run_mode, status;
  std::vector<Fact> facts;   ///< head: protocol, date, rig, ...
  std::vector<Fact> health;  ///< xruns, calibration age, restarts, ...
  Design design = Design::forced_choice;
  int alternatives = 2;
  terms::Function function = terms::Function::weibull;
  analysis::Scale scale = analysis::Scale::linear;
  std::string level_label;              ///< with the unit, for an axis: "Contrast (dB)"
  std::string level_unit;               ///< "" for a level without one
  std::vector<std::string> choices;     ///< ids, in the order of their indices
  int positive = 1;                     ///< has_noise(): the choice that means "yes"
  bool scored = true;                   ///< whether answers are right or wrong
  std::vector<std::string> conditions;  ///< in the order of a report; TrialRecord::instruction is one of them
  std::optional<std::vector<std::string>> show;  ///< of the protocol; none: all that suits the design
  std::vector<StaircaseResult> staircases;
  std::vector<analysis::TrialRecord> trials;
  /// Where the answers chose the levels: intervals are of the posterior under this prior. None: levels were
  /// fixed before the session, and intervals come from bootstraps.
  std::optional<analysis::Prior> prior;
  analysis::TimeExclusion exclusion;
  std::uint64_t seed = 1;  ///< of the bootstraps
  int replicates = 1000;
};

/// Whether the report has this part: "psychometric", "ez", "bis", "lisas", "ies", "caf", "dprime", "trace".
/// Without a choice of the protocol all but d', which is then for yes/no alone.
bool shows(const SessionData& data, const std::string& part);

}  // namespace turnpoint::report
