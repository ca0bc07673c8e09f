#pragma once
#include <vector>

#include "station/procedure/track.hpp"

namespace turnpoint::procedure {

/// Staircases: n-down-m-up (Levitt 1971) and weighted up-down (Kaernbach 1991; step_up = step_down p / (1 -
/// p), p is the target). Each reversal switches to the next step size. The estimate is the mean of the
/// reversals, or of their logarithms if steps multiply the level. It leaves out the first `discard_reversals`
/// and, if the number of the others is odd, one more.
class Staircase : public Track {
 public:
  explicit Staircase(const Spec& spec);

  std::map<std::string, Estimate> estimates() const override;

 private:
  void learn(Answer answer) override;
  void step_towards(Direction direction);
  void step_towards(Direction direction, const std::vector<double>& sizes);

  std::vector<double> steps_down_, steps_up_;
  std::vector<double> steps_unsure_;  ///< upwards, after an answer of those who do not want to guess
  int ones_ = 0, zeros_ = 0;
};

}  // namespace turnpoint::procedure
