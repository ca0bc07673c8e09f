#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/procedure/spec.hpp"
#include "station/random/draws.hpp"

namespace turnpoint::procedure {

/// A level to present. Constant stimuli also give the level of each balanced factor.
struct Proposal {
  double level = 0;
  /// pairs of a factor and the index of its level
  std::vector<std::pair<std::string, std::size_t>> balanced;
};

/// The result of a proposal. Nothing is learnt from a trial without an answer (timeout, anticipation).
enum class Answer { one, zero, none };  ///< one: correct, or the tracked answer

struct Estimate {
  double mode = 0, mean = 0;
  /// standard deviation of the estimate; empty if the estimate rests on a single number
  std::optional<double> sd;
  /// for a track: what the estimate was computed from, "reversals 5 to 12 of 12"; otherwise empty
  std::string basis;
};

/// What constant stimuli need to know about the protocol: the number of levels of each balanced factor, and
/// the right answer at a level (for limiting runs of equal right answers; -1: none).
struct Context {
  std::map<std::string, std::size_t> factor_levels;
  std::function<int(double level)> right_answer;
  /// Unanswered trials count as presented (the deadline is part of the design) and are not repeated.
  bool unanswered_are_data = false;
};

/// Chooses the next level. Pure: no clock, no file; the same key and answers give the same levels. Between
/// two records, next() always returns the same proposal.
class Procedure {
 public:
  virtual ~Procedure() = default;
  /// the next level to present; empty when the procedure is done
  virtual std::optional<Proposal> next() const = 0;
  /// records the answer to the proposal of next(); not allowed when done
  virtual void record(Answer answer) = 0;
  /// Records the setting of an adjustment; other kinds throw std::logic_error.
  virtual void record_setting(double setting);
  virtual int recorded() const = 0;  ///< number of trials that count
  virtual int expected() const = 0;  ///< total number of trials; an estimate if a rule stops the procedure
  virtual std::map<std::string, Estimate> estimates() const { return {}; }
  virtual std::optional<double> entropy_nats() const { return std::nullopt; }
  virtual std::vector<double> reversals() const { return {}; }
  virtual std::uint64_t state_hash() const = 0;  ///< hash of the discrete state: counters and indices
};

/// Makes the procedure. Throws std::invalid_argument with the first problem of validate(). `key` gives the
/// block and attempt; the procedure chooses stream and trial itself.
std::unique_ptr<Procedure> make_procedure(const Spec& spec, const Context& context, const random::Key& key);

}  // namespace turnpoint::procedure
