#include "station/rehearsal/cue_score.hpp"

#include <cmath>

namespace turnpoint::rehearsal {

Score sum_of(const std::vector<Score>& sessions) {
  Score sum;
  for (const auto& one : sessions) sum.add(one, 1);
  return sum;
}

double standard_error(const std::vector<Score>& sessions) {
  const auto all = sum_of(sessions);
  if (all.trials == 0) return 0;
  double error = 0;
  for (const double less : {0.0, 1.0}) {
    const auto more = [&](const Score& score) { return score.right - less * score.keys[all.best_key()]; };
    const double share = more(all) / all.trials;
    double squares = 0;
    for (const auto& one : sessions) squares += std::pow(more(one) - share * one.trials, 2);
    error = std::max(error, std::sqrt(squares) / all.trials);
  }
  return error;
}

}  // namespace turnpoint::rehearsal
