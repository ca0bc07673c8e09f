#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// The levels that a procedure presents in response to given answers.
struct Trace {
  std::vector<double> levels;  ///< the level that was presented before each answer
  std::optional<double> next;  ///< the next level; empty if the procedure has stopped
  /// if the procedure has a second dimension: its value at each answer, and the next one
  std::vector<double> second;
  std::optional<double> next_second;
  std::map<std::string, Estimate> estimates;
  std::optional<double> entropy_nats;
  std::vector<double> reversals;
};

/// Runs a procedure on answers of 1 (right, or the tracked answer) and 0. Throws core::UsageError for any
/// other character, or for answers after the procedure has stopped.
Trace trace(const Spec& spec, const Context& context, const std::string& answers,
            const core::DrawKey& key = {});

}  // namespace turnpoint::procedure
