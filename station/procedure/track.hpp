#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// The levels that whole steps reach: a start plus a whole number of each of some steps. The numbers are
/// counted and the level is computed from them, so it is the same to the last bit however it was reached. If
/// start and steps are decimal fractions, it is the number nearest to the exact decimal. On a log10 or dB
/// scale, steps multiply the level.
///
/// Between `min` and `max` the level stops at the last one that whole numbers of the largest common step
/// reach. If the steps have no common one (such as 1 and 2.414), it stops at the limit, and counting starts
/// again there.
class Ladder {
 public:
  Ladder() = default;
  Ladder(const Spec& spec, const std::vector<double>& steps);

  double level() const;
  /// Moves by one of the steps, upwards or downwards. Returns false if a limit leaves the level where it is.
  bool move(double step, bool upwards);

 private:
  Scale scale_ = Scale::linear;
  double start_ = 0;
  std::optional<double> min_, max_;
  /// Decimal fractions: the steps are whole numbers of 1 / per_one_, and so is the start of a linear scale.
  double per_one_ = 0;  ///< 0 if the steps are no decimal fractions
  std::int64_t units_ = 0, common_ = 1;
  std::optional<std::int64_t> lowest_, highest_;
  /// Other steps: their sizes, and how often each was taken upwards more than downwards.
  std::vector<double> sizes_;
  std::vector<std::int64_t> counts_;
};

/// The common part of all procedures that move one level up and down: limits and scale of the level,
/// reversals, and stopping rules. learn() moves the level after each answer. A reversal is the level at which
/// the direction changed. An unanswered trial is repeated at the same level, up to three times in a row. If
/// the last repeat is unanswered as well, one trial of the budget counts as used, and the track continues. A
/// track also ends after most_trials() trials, and when the end of its range has stopped steps_at_limit()
/// steps in a row.
class Track : public Procedure {
 public:
  /// `steps` are all sizes with which step() is called.
  explicit Track(const Spec& spec, const std::vector<double>& steps = {});

  std::optional<Proposal> next() const override;
  void record(Answer answer) final;
  int recorded() const override { return recorded_; }
  int expected() const override;
  Ended ended() const override;
  std::optional<core::Phrase> end() const override;
  std::vector<double> reversals() const override { return reversals_; }
  std::uint64_t state_hash() const override;

 protected:
  /// Updates the procedure with an answer and moves the level if necessary.
  virtual void learn(Answer answer) = 0;

  enum class Direction { none, down, up };
  /// Records a reversal if the direction differs from that of the previous step.
  void turn(Direction direction);
  /// Moves the level by a step on its scale, but not beyond its limits.
  void step(double size, Direction direction);
  /// The same for a signed amount of any size.
  void move(double amount);
  /// Appends to the basis of an estimate how the track ended, if that was not by its rules.
  std::string with_end(std::string basis) const;

  Spec spec_;
  double level_ = 0;
  int recorded_ = 0;
  Direction direction_ = Direction::none;
  std::vector<double> reversals_;

 private:
  bool rules_met() const;
  void count_stopped(bool moved);

  Ladder ladder_;
  int unanswered_ = 0, spent_ = 0;
  int stopped_ = 0;  ///< number of steps in a row that the end of the range has stopped
  std::vector<Answer> answers_;
};

}  // namespace turnpoint::procedure
