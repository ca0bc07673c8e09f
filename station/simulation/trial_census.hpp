#pragma once
#include <functional>
#include <map>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::simulation {

/// Answers a trial of a simulated session with the index of a choice.
using Answers = std::function<int(const trial::TrialSpec&)>;

/// Counts which trials a session contains. Practice and warm-up are left out. What chance alone decides is
/// not counted as it was drawn but has its exact probability: factors that are drawn or balanced, and catch
/// trials.
class TrialCensus {
 public:
  explicit TrialCensus(const protocol::Protocol& protocol);

  void add(const protocol::Block& block, const trial::TrialSpec& trial);
  /// So many trials of a procedure (or of the block's fixed levels) with each of these levels equally often.
  void add(const protocol::Block& block, const procedure::Spec* spec, const std::vector<double>& levels,
           double trials);
  void add(const TrialCensus& other);

  /// How many trials there are of each kind, by the factors that block, procedure or catch trial set.
  const std::map<protocol::Factors, double>& cells() const { return cells_; }
  /// All factors that the trials of a cell can have, each equally likely.
  std::vector<protocol::Factors> combinations(const protocol::Factors& cell) const;

 private:
  const protocol::Protocol* protocol_;
  std::vector<const protocol::Factor*> relevant_;  ///< on which the task's scenes and right answers depend
  std::map<protocol::Factors, double> cells_;
};

/// Whether outside practice a procedure chooses levels by whether answers are right.
bool levels_follow_right_answers(const protocol::Protocol& protocol);

/// One session whose practice is passed.
TrialCensus census_of_session(const protocol::Protocol& protocol, std::uint64_t seed, const Answers& answers);

/// What a session contains on average, exactly, from the protocol alone. A procedure that follows the answers
/// counts with each level that it can present equally often. Only where a block shows fewer trials than its
/// procedures have, and not any of them alike (several procedures, no shuffling, `max_run`), sessions with
/// 40 000 trials are counted: any share of the trials is then known to 0.25 % (one standard error).
TrialCensus census_of(const protocol::Protocol& protocol);

}  // namespace turnpoint::simulation
