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
  same_different,  ///< "different" rises with the level; its lower asymptote is fitted
  adjustment,      ///< no psychometric function
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
  analysis::Function function = analysis::Function::weibull;
  analysis::Scale scale = analysis::Scale::linear;
  std::string level_label;           ///< with the unit
  std::vector<std::string> choices;  ///< labels, in the order of their indices
  std::vector<analysis::TrialRecord> trials;
  /// Where the answers chose the levels: intervals are of the posterior under this prior. None: levels were
  /// fixed before the session, and intervals come from bootstraps.
  std::optional<analysis::Prior> prior;
  analysis::TimeExclusion exclusion;
  std::uint64_t seed = 1;  ///< of the bootstraps
  int replicates = 1000;
};

/// What stands in the last parentheses of a level's label; "" without any.
std::string unit_of(const std::string& level_label);

}  // namespace turnpoint::report
