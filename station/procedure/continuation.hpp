#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// What a procedure that continues on another day presented before, and how it was answered.
struct EarlierTrial {
  double level = 0;
  Answer answer = Answer::none;
  std::optional<double> second = {};  ///< value of the second dimension, if the procedure has one
};
/// The trials of the participant's earlier sessions, in order, by the name of the procedure.
using EarlierTrials = std::map<std::string, std::vector<EarlierTrial>>;

/// Brings a new procedure into the state after these trials. Throws core::Failure if it would not have
/// presented the same levels.
void continue_from(const std::vector<EarlierTrial>& trials, const Spec& spec, Procedure& procedure);

}  // namespace turnpoint::procedure
