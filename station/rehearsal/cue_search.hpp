#pragma once
#include <map>
#include <vector>

#include "station/rehearsal/cue_observer.hpp"

namespace turnpoint::rehearsal {

/// Searches for the rule with which an observer of one cue does best in sessions of its own, in a task with
/// one interval and two answers. There the observer's answers decide which levels come and how often each
/// answer is right, so the best rule is not known beforehand.
///
/// The rules are a criterion or a band of the cue, with ends between any two values of the cue or, if there
/// are many values, at up to 24 places. They compete: all of them do a few sessions, the better ones do more.
/// Where there are more places, the ends of the last rules are moved to places between. Two rules that give
/// the same answers in all kinds of trials, at the strengths sampled here, count as one.
class CueSearch {
 public:
  explicit CueSearch(CueObserver& observer) : observer_(observer) {}

  /// Returns nothing if no rule can gain 1 % over the better key, whichever trials come. Throws Finished, and
  /// protocol::Abandoned.
  std::optional<Strategy> best(const CueKind& kind, const Grain& grain, const Cells& all);

 private:
  /// How many sessions each contender has done at the end of a round, and how many contenders then remain.
  struct Round {
    int sessions;
    std::size_t kept;
  };
  /// What one feature of a cue shows in all kinds of trials.
  struct View {
    Feature feature = Feature::last;
    Grain grain;
    std::vector<double> places;  ///< possible ends of a range, in ascending order
    /// those of them at which ranges end in the first rounds, by their numbers, which begin with 1
    std::vector<std::size_t> coarse;
    struct Seen {
      std::size_t place = 0;  ///< number of places that are not above the cue
      std::size_t group = 0;  ///< number of the kind of trial and the right answer
      double share = 0;       ///< how large a part of its group it is
    };
    std::vector<Seen> seen;
    std::vector<int> right;  ///< the right answer of each group
  };
  /// A rule: one answer from one place up to another place, and the other answer elsewhere.
  struct Contender {
    const View* view = nullptr;
    /// the numbers of the places where the band begins and ends: the cue lies in it if
    /// from <= View::Seen::place < to
    std::size_t from = 0, to = 0;
    int inside = 0;              ///< the answer in the band
    OwnSessions* own = nullptr;  ///< sessions that it shares with rules that give the same answers
    double gain = 0;

    int answer(std::size_t place) const { return place >= from && place < to ? inside : 1 - inside; }
    Strategy strategy() const;
  };

  View view_of(const CueKind& kind, Feature feature, const Grain& grain, const Cells& all) const;
  static double possible_gain(const Contender& one);
  /// Adds a contender, unless it cannot help or gives the same answers as an earlier one.
  void enter(std::vector<Contender>& field, Contender one);
  void enter_all(std::vector<Contender>& field, const View& view);
  void enter_neighbours(std::vector<Contender>& field);
  void race(const CueKind& kind, std::vector<Contender>& field, Round round);

  CueObserver& observer_;
  /// the sessions of each rule tried so far with any cue, by its answers in all kinds of trials
  std::map<std::vector<bool>, OwnSessions> tried_;
};

}  // namespace turnpoint::rehearsal
