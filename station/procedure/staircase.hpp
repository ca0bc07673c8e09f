#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// n-down-m-up (Levitt 1971) and weighted up-down (Kaernbach 1991; step_up = step_down p / (1 - p))
/// staircases. A step follows the answer at once; a reversal is the level at which the direction changed;
/// step sizes move on with each reversal. On a log10 or dB scale steps multiply. An unanswered trial brings
/// the same level again, at most three times in a row, then the staircase is left as it is and goes on
/// asking. The estimate is the mean of the reversals (of their logarithms where steps multiply) without the
/// first `discard_reversals`, and without one more where an odd number is left.
class Staircase : public Procedure {
 public:
  Staircase(const Spec& spec, const Context& context);

  std::optional<Proposal> next() const override;
  void record(Answer answer) override;
  int recorded() const override { return recorded_; }
  int expected() const override;
  std::vector<double> reversals() const override { return reversals_; }
  std::map<std::string, Estimate> estimates() const override;
  std::uint64_t state_hash() const override;

 private:
  enum class Direction { none, down, up };
  bool done() const;
  void move(Direction direction);
  double step(const std::vector<double>& steps) const;

  Spec spec_;
  std::vector<double> steps_down_, steps_up_;
  double level_ = 0;
  int recorded_ = 0, ones_ = 0, zeros_ = 0;
  int unanswered_ = 0, spent_ = 0;
  Direction direction_ = Direction::none;
  std::vector<double> reversals_;
  std::vector<Answer> answers_;
};

}  // namespace turnpoint::procedure
