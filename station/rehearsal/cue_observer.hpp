#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/rehearsal/cue_guard.hpp"
#include "station/rehearsal/cue_kinds.hpp"
#include "station/rehearsal/cue_score.hpp"
#include "station/rehearsal/cue_table.hpp"
#include "station/rehearsal/one_cue.hpp"
#include "station/rehearsal/trial_census.hpp"

namespace turnpoint::rehearsal {

/// Thrown if the cues of some trials can neither be planned nor interpolated.
struct NotPlanned : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown when the caller asks to end the comparison early and to report what has been compared so far.
struct Finished {};

struct Presentation {
  std::vector<Interval> intervals;
  int correct = 0;
  /// probability that a trial of this kind (cell) has this order of intervals and this combination of factors
  double share = 0;
  double turn = 0.5;  ///< offset into the sequence of quasi-random strengths (see looks())
};

/// All cells (kinds of trial) of the census, each with its possible presentations and its number of trials.
using Cells = std::vector<std::pair<const std::vector<Presentation>*, double>>;

/// Strengths are drawn in two equally large sets for each trial. The first set chooses the rule and the
/// second measures its accuracy, because any rule looks too good on the draws for which it was chosen.
enum class Draws { to_choose, to_judge };

struct Strategy {
  Feature feature = Feature::last;
  Rule rule;

  bool operator==(const Strategy& other) const {
    return feature == other.feature && rule.ranges == other.rule.ranges;
  }
};

/// Simulated sessions in which the observer's answers determine the next level. Two cues that give the same
/// answers in all presented trials lead to the same sessions, so the second cue reuses the sessions of the
/// first.
struct OwnSessions {
  std::vector<Score> done;
  /// for each kind of trial (cell) that occurred: the expected score of one trial
  std::map<const std::vector<Presentation>*, Score> scores;
  Cells visited;
  std::vector<Shares> answers;  ///< the observer's answers in each kind of trial (cell) of `visited`
  /// true if all trials of each kind that occurred get the same answer, so that chance plays no part
  bool certain = true;
  Score sum;
  double error = 0;  ///< three standard errors of the accuracy or of its gain over the best key
};

/// An observer who uses only one cue: what it sees in the trials of a protocol, how often its answers are
/// right, and the sessions that it does itself. For cue_guard().
class CueObserver {
 public:
  /// Throws what CueTable throws. The references must outlive the observer.
  CueObserver(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
              const std::stop_token& stop, const Steps& steps)
      : protocol_(protocol),
        stop_(stop),
        steps_(steps),
        asked_(asked_by(protocol.task)),
        table_(protocol, rig, survey) {}

  const Asked& asked() const { return asked_; }
  double guessing() const { return 1.0 / static_cast<double>(asked_.answers); }
  double chance(const Score& score) const { return std::max(guessing(), score.one_key()); }
  /// Sets how many strengths stand for the roving of a trial.
  void set_points(int points) { points_ = points; }

  /// The kinds of trial of a census. Throws NotPlanned.
  Cells cells_of(const TrialCensus& census);
  std::vector<Look> looks(const CueKind& kind, Feature feature, const Cells& cells, Draws draws) const;
  Score score(const CueKind& kind, const Strategy& strategy, const Cells& cells) const;

  /// The best strategy if each kind of trial is as frequent as in the census.
  Strategy best_strategy(const CueKind& kind, const Grain& grain, const Cells& all) const;
  /// Which features of this cue the observer can use.
  std::vector<Feature> features_of(const CueKind& kind) const;

  /// Simulates sessions with seeds from `first_seed` on, until `own` has `count` of them, or until it is
  /// certain that all are alike. Throws Finished, and protocol::Abandoned.
  void run_sessions(const CueKind& kind, const Strategy& strategy, int count, OwnSessions& own,
                    std::uint64_t first_seed);
  /// What a strategy reaches in sessions of its own. Throws Finished, and protocol::Abandoned.
  Reached by_itself(const CueKind& kind, const Strategy& strategy, const Cells& all);
  /// The accuracy of an observer who always presses this key, in the sessions to which this leads.
  Reached by_key(const CueKind& kind, int key, const Cells& all);

 private:
  Interval interval_of(const std::vector<std::string>& scenes, const protocol::Factors& factors);
  const std::vector<Interval>& intervals_of(const trial::TrialSpec& trial);
  const std::vector<Presentation>& presentations(const protocol::Factors& cell, const TrialCensus& census);
  int answer(const CueKind& kind, const Strategy& strategy, const trial::TrialSpec& trial,
             std::uint64_t seed);
  Score score(const Strategy& strategy, const std::vector<Look>& looks) const;
  std::vector<Shares> answers_to(const Cells& cells, const CueKind& kind, const Strategy& strategy) const;
  std::pair<double, double> accuracies(const CueKind& kind, const Strategy& strategy, const Cells& all) const;
  const OwnSessions& own_sessions(const CueKind& kind, const Strategy& strategy);
  const std::vector<Look>& looks_in(const CueKind& kind, Feature feature,
                                    const std::vector<Presentation>& presentations);

  const protocol::Protocol& protocol_;
  const std::stop_token& stop_;
  const Steps& steps_;
  Asked asked_;
  CueTable table_;
  int points_ = 256;
  double turn_ = 0.5;
  std::map<protocol::Factors, std::vector<Presentation>> presentations_;
  std::map<std::pair<std::vector<std::vector<std::string>>, protocol::Factors>, std::vector<Interval>>
      intervals_;
  std::vector<OwnSessions> own_sessions_;
  /// the looks of each kind of trial at the cue `looked_at_`, for one trial
  const CueKind* looked_at_ = nullptr;
  std::map<std::pair<Feature, const std::vector<Presentation>*>, std::vector<Look>> looks_;
};

}  // namespace turnpoint::rehearsal
