#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// The common part of all procedures that move one level up and down: limits and scale of the level,
/// reversals, and stopping rules. learn() moves the level after each answer. A reversal is the level at which
/// the direction changed. On a log10 or dB scale, steps multiply the level. An unanswered trial is repeated
/// at the same level, up to three times in a row. If the last repeat is unanswered as well, one trial of the
/// budget counts as used, and the track continues.
class Track : public Procedure {
 public:
  explicit Track(const Spec& spec);

  std::optional<Proposal> next() const override;
  void record(Answer answer) final;
  int recorded() const override { return recorded_; }
  int expected() const override;
  std::vector<double> reversals() const override { return reversals_; }
  std::uint64_t state_hash() const override;

 protected:
  /// Updates the procedure with an answer and moves the level if necessary.
  virtual void learn(Answer answer) = 0;

  enum class Direction { none, down, up };
  /// Records a reversal if the direction differs from that of the previous step.
  void turn(Direction direction);
  /// Moves the level by this signed amount on its scale, but not beyond its limits.
  void move(double size);

  Spec spec_;
  double level_ = 0;
  int recorded_ = 0;
  Direction direction_ = Direction::none;
  std::vector<double> reversals_;

 private:
  bool done() const;

  int unanswered_ = 0, spent_ = 0;
  std::vector<Answer> answers_;
};

}  // namespace turnpoint::procedure
