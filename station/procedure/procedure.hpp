#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/draws.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// A level to present. For constant stimuli, a proposal also contains the level of each balanced factor.
struct Proposal {
  double level = 0;
  std::optional<double> second = {};  ///< value of the second dimension, if the procedure has one
  /// pairs of a factor and the index of its level
  std::vector<std::pair<std::string, std::size_t>> balanced = {};
  std::vector<double> against = {};  ///< for comparisons: values of the factors Spec::against
};

/// A proposal that may come next: its first place in the rest of the list, counted from that of next(), and how
/// often it comes in the present repeat of the list and in all of its rest.
struct Candidate {
  Proposal proposal;
  std::size_t place = 0;
  int in_repeat = 1, in_all = 1;
};

/// How the participant answered at the level that the procedure proposed.
enum class Answer {
  one,    ///< the answer was right; or, if the procedure measures how often one answer is given, it was that
          ///< one
  zero,   ///< any other answer
  none,   ///< no valid answer (timeout, anticipation), from which the procedure learns nothing
  unsure  ///< the participant did not want to guess
};

/// An unanswered trial is repeated at the same level, up to kRepeatsInARow times. If the last repeat is
/// unanswered as well, one trial counts as spent. A procedure that a number of trials does not end is over
/// after kSpentAtMost spent trials, so that it ends even if nobody answers.
inline constexpr int kRepeatsInARow = 3, kSpentAtMost = 20;

/// Why a procedure has ended. All but `rule` are ends that its stopping rules did not ask for.
enum class Ended {
  no,          ///< it has not ended
  rule,        ///< its list is done, or its stopping rules are met
  limit,       ///< the end of its range stopped steps_at_limit() steps in a row
  most,        ///< it has reached most_trials() before its rules were met
  unanswered,  ///< too many trials were left unanswered (kSpentAtMost)
};

/// Says about the procedure with this name how it ended if that was not by its rules; otherwise empty.
/// `count` is the number of steps or trials.
std::optional<core::Phrase> end_in_words(Ended ended, const std::string& procedure, int count);

/// How pages and reports call an estimated parameter, such as "threshold". A parameter of a separate program keeps the
/// name that the program gives it.
core::Phrase parameter_name(const std::string& parameter);

struct Estimate {
  double mode = 0, mean = 0;
  /// standard deviation of the estimate; empty if the estimate is a single number
  std::optional<double> sd;
  /// central 95 % credible interval, if the estimate comes from a posterior
  std::optional<std::pair<double, double>> interval;
  /// for a track: the data from which the estimate was computed, "reversals 5 to 12 of 12"; otherwise ""
  std::string basis;
};

/// The estimate of the threshold at one value of the second dimension.
struct ThresholdAt {
  double second = 0;
  Estimate estimate;
};

class Programs;

/// What constant stimuli need to know about the protocol: the number of levels of each balanced factor.
struct Context {
  std::map<std::string, std::size_t> factor_levels;
  /// true if the deadline is part of the design: unanswered trials then count as presented and are not
  /// repeated
  bool unanswered_are_data = false;
  /// starts the programs of procedures that are programs; may be null if there are none
  Programs* programs = nullptr;
};

/// Chooses the next level. Pure: it uses no clock and no file, and the same key and answers give the same
/// levels. next() returns the same proposal until the next call of record(). A procedure that is a separate
/// program (procedure/program.hpp) is the exception: it may not be ready yet, and next() may throw
/// core::ProgramFailed.
class Procedure {
 public:
  virtual ~Procedure() = default;
  /// true if next() would not wait for a program
  virtual bool ready() const { return true; }
  /// returns the next level to present; empty when the procedure is done
  virtual std::optional<Proposal> next() const = 0;
  /// The different proposals that choose() may make the next one, in their order: those of the rest of a shuffled
  /// list, or of its present repeat, whose values may change their balanced factors with those of later repeats.
  /// Only that of next() if there is no choice. Empty when the procedure is done.
  virtual std::vector<Candidate> candidates() const;
  /// the proposal at this place
  virtual Proposal choice(std::size_t) const { return next().value(); }
  virtual void choose(std::size_t) {}
  /// why next() returns nothing
  virtual Ended ended() const { return next() ? Ended::no : Ended::rule; }
  /// says the same if it was not by its rules; otherwise empty
  virtual std::optional<core::Phrase> end() const { return std::nullopt; }
  /// records the answer to the proposal of next(); must not be called when the procedure is done
  virtual void record(Answer answer) = 0;
  /// Records the setting of an adjustment. Other kinds of procedures throw std::logic_error.
  virtual void record_setting(double setting);
  virtual int recorded() const = 0;  ///< number of recorded trials that count towards the total
  /// total number of trials; an estimate if a stopping rule decides when the procedure ends
  virtual int expected() const = 0;
  virtual std::map<std::string, Estimate> estimates() const { return {}; }
  /// the threshold at each value of the second dimension, if the procedure has one
  virtual std::vector<ThresholdAt> thresholds() const { return {}; }
  virtual std::optional<double> entropy_nats() const { return std::nullopt; }
  virtual std::vector<double> reversals() const { return {}; }
  /// hash of the discrete state (counters and indices), to check whether two procedures are in the same state
  virtual std::uint64_t state_hash() const = 0;
};

/// The key of a procedure in a session. `block` is the number of the block, and `place` is the position of
/// the procedure in the block's list, so that interleaved procedures draw different numbers.
core::DrawKey key_of(std::uint64_t seed, int block, std::size_t place, int attempt);

/// Makes the procedure. Throws std::invalid_argument with the first problem of validate(). `key` needs seed,
/// block and attempt; the procedure sets stream and trial itself.
std::unique_ptr<Procedure> make_procedure(const Spec& spec, const Context& context, const core::DrawKey& key);

}  // namespace turnpoint::procedure
