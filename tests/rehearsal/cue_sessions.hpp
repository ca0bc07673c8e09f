#pragma once
// Sessions in which an observer of one cue gives every answer, and the search for the rule that does best in
// them.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "tests/rehearsal/cue_strategies.hpp"
#include "tests/rehearsal/cue_world.hpp"

namespace turnpoint::tests {

/// Counts for one session: right answers of the observer, and right answers that pressing always the same key
/// would give, for each key.
struct Count {
  double trials = 0, right = 0;
  std::array<double, 9> keys{};

  void add(const Count& other);
};

struct OwnSessions {
  double gain = 0, error = 0;
};

/// A strategy for one feature of a cue.
struct Candidate {
  std::size_t cue = 0;
  int feature = 0;
  Strategy strategy;
};

/// Simulates sessions with seeds from `first_seed` on until there are `count` of them. The answers of the
/// candidate also steer the procedure.
void do_sessions(std::vector<Count>& each, const protocol::Protocol& protocol, World& world,
                 const Candidate& candidate, std::size_t count, std::uint64_t first_seed);

/// The gain of a candidate over guessing or over always pressing the same key, whichever is better in its
/// sessions. There are at least 600 sessions and 25 000 trials, and more sessions if they differ much.
OwnSessions judged_gain(const protocol::Protocol& protocol, World& world, const Candidate& candidate);

/// The gain over guessing of an observer who always presses the same key, with the best key.
OwnSessions gain_of_keys(const protocol::Protocol& protocol, World& world);

/// Tries rules for one interval and two answers in sessions of their own: criteria and bands, with ends
/// between all values of the cue or at about 22 places, and both ways to answer unless one is clearly worse.
class Tournament {
 public:
  Tournament(const protocol::Protocol& protocol, World& world, const std::vector<Seen>& seen);

  /// The gain of the candidate that does best, of `others` and of all criteria and bands for this cue.
  OwnSessions best_gain(std::size_t cue, int features, const std::vector<Candidate>& others);

 private:
  struct Entrant {
    Candidate candidate;
    const std::vector<bool>* answers = nullptr;
    double gain = 0;
  };

  void enter(std::vector<Entrant>& field, Candidate candidate, bool also_if_bad);
  void enter_all(std::vector<Entrant>& field, std::size_t cue, int feature);
  void play(std::vector<Entrant>& field, std::size_t sessions, std::size_t kept);

  const protocol::Protocol& protocol_;
  World& world_;
  std::vector<Seen> seen_;
  /// the trial sessions and the judged gain of each rule, by its answers in the watched trials
  std::map<std::vector<bool>, std::vector<Count>> tried_;
  std::map<std::vector<bool>, OwnSessions> judged_;
};

}  // namespace turnpoint::tests
