#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::rehearsal {

/// Answers a trial of a simulated session. Returns the index of a choice.
using Answers = std::function<int(const trial::TrialSpec&)>;

/// Counts the trials of a session by kind. Practice and warm-up are left out. Where chance decides (drawn or
/// balanced factors, catch trials), each kind is counted by its exact probability, not by what was drawn in
/// this session.
class TrialCensus {
 public:
  explicit TrialCensus(const protocol::Protocol& protocol);

  void add(const protocol::Block& block, const trial::TrialSpec& trial);
  /// Adds `trials` trials of a procedure, with each of `levels` equally often, combined with each of
  /// `seconds` if the procedure has a second dimension. Without a procedure (`spec` is null), the levels are
  /// the block's fixed levels.
  void add(const protocol::Block& block, const procedure::Spec* spec, const std::vector<double>& levels,
           const std::vector<double>& seconds, double trials);

  /// The number of trials of each kind (cell). A cell is identified by the factors that the block, procedure
  /// or catch trial sets.
  const std::map<protocol::Factors, double>& cells() const { return cells_; }
  /// All combinations of factors that the trials of one cell (one kind of trial) can have. Each is equally
  /// likely.
  std::vector<protocol::Factors> combinations(const protocol::Factors& cell) const;

 private:
  const protocol::Protocol* protocol_;
  /// factors on which the task's scenes and right answers depend
  std::vector<const protocol::Factor*> relevant_;
  std::map<protocol::Factors, double> cells_;
};

/// True if, outside practice, a procedure chooses levels depending on the answers.
bool levels_follow_answers(const protocol::Protocol& protocol);

/// True if, in addition, the proportion correct over all levels says little about an observer whose own
/// answers set the levels: because the procedure follows right answers, or because it follows the answer
/// "yes" and chooses between levels with a signal and levels without. If a procedure follows one of two
/// answers of another kind, the share of that answer converges on the target and reveals nothing.
bool needs_own_sessions(const protocol::Protocol& protocol);

/// Simulates one session in which the participant passes practice, and counts its trials.
TrialCensus census_of_session(const protocol::Protocol& protocol, std::uint64_t seed, const Answers& answers);

/// Returns the average number of trials of each kind in a session, computed exactly from the protocol. If a
/// procedure chooses levels from the answers, each level that it can present counts equally often. One case
/// is sampled instead of computed: a block that has fewer trials than its procedures provide, and whose first
/// trials differ from the rest (several procedures, no shuffling, or `max_run`). For such a block, sessions
/// with 40 000 trials in total are counted. The standard error of each proportion is then at most 0.25 %.
TrialCensus census_of(const protocol::Protocol& protocol);

}  // namespace turnpoint::rehearsal
