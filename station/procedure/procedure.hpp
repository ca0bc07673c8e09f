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

/// A level to present. Constant stimuli also say which level of each balanced factor goes with it.
struct Proposal {
  double level = 0;
  std::vector<std::pair<std::string, std::size_t>> balanced;  ///< factor, index of its level
};

/// What came of a proposal. Without an answer (timeout, anticipation) nothing is learnt.
enum class Answer { one, zero, none };  ///< one: correct, or the tracked answer

struct Estimate {
  double mode = 0, mean = 0;
  std::optional<double> sd;  ///< none where a single number is all that there is
  std::string basis;         ///< of a track: what it is taken from, "reversals 5 to 12 of 12"; else empty
};

/// What constant stimuli must know of the protocol: how many levels each balanced factor has, and which
/// answer is right at a level (for runs of equal right answers; -1: none).
struct Context {
  std::map<std::string, std::size_t> factor_levels;
  std::function<int(double level)> right_answer;
  /// Unanswered trials count as presented (the deadline belongs to the design) instead of coming again.
  bool unanswered_are_data = false;
};

/// Chooses the next level. Pure: no clock, no file; the same key and answers give the same levels. next() may
/// be called any number of times between two records and says the same.
class Procedure {
 public:
  virtual ~Procedure() = default;
  virtual std::optional<Proposal> next() const = 0;  ///< none: done
  virtual void record(Answer answer) = 0;            ///< of the proposal that next() gives; not after done
  /// The same for a setting of an adjustment; other kinds throw std::logic_error.
  virtual void record_setting(double setting);
  virtual int recorded() const = 0;  ///< trials that counted
  virtual int expected() const = 0;  ///< in all, an estimate where a rule stops it
  virtual std::map<std::string, Estimate> estimates() const { return {}; }
  virtual std::optional<double> entropy_nats() const { return std::nullopt; }
  virtual std::vector<double> reversals() const { return {}; }
  virtual std::uint64_t state_hash() const = 0;  ///< of discrete state: counters and indices
};

/// Throws std::invalid_argument with the first fault of validate(). `key` gives the block and attempt; its
/// stream and trial are the procedure's own.
std::unique_ptr<Procedure> make_procedure(const Spec& spec, const Context& context, const random::Key& key);

}  // namespace turnpoint::procedure
