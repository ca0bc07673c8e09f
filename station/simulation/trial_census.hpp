#pragma once
#include <functional>
#include <map>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::simulation {

/// Answers a trial of a simulated session with the index of a choice.
using Answers = std::function<int(const trial::TrialSpec&)>;

/// Counts the trials of a session by kind. Practice and warm-up are left out. Whatever only chance decides
/// (drawn or balanced factors, catch trials) is not counted as it was drawn but enters with its exact
/// probability.
class TrialCensus {
 public:
  explicit TrialCensus(const protocol::Protocol& protocol);

  void add(const protocol::Block& block, const trial::TrialSpec& trial);
  /// Adds this number of trials of a procedure (or of the block's fixed levels), with each of these levels
  /// equally often.
  void add(const protocol::Block& block, const procedure::Spec* spec, const std::vector<double>& levels,
           double trials);
  void add(const TrialCensus& other);

  /// The number of trials of each kind, by the factors that block, procedure or catch trial set.
  const std::map<protocol::Factors, double>& cells() const { return cells_; }
  /// All factors that the trials of a cell can have, each equally likely.
  std::vector<protocol::Factors> combinations(const protocol::Factors& cell) const;

 private:
  const protocol::Protocol* protocol_;
  /// factors on which the task's scenes and right answers depend
  std::vector<const protocol::Factor*> relevant_;
  std::map<protocol::Factors, double> cells_;
};

/// True if, outside practice, a procedure chooses levels by whether answers are right.
bool levels_follow_right_answers(const protocol::Protocol& protocol);

/// Counts one session in which practice is passed.
TrialCensus census_of_session(const protocol::Protocol& protocol, std::uint64_t seed, const Answers& answers);

/// The average content of a session, computed exactly from the protocol. If a procedure follows the answers,
/// each level that it can present counts equally often. One case is sampled instead: if a block has fewer
/// trials than its procedures, and they are not all alike (several procedures, no shuffling, `max_run`),
/// sessions with 40 000 trials are counted, which gives any share of the trials with a standard error of 0.25
/// %.
TrialCensus census_of(const protocol::Protocol& protocol);

}  // namespace turnpoint::simulation
