#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "station/rehearsal/one_cue.hpp"

namespace turnpoint::rehearsal {

/// Counts trials, right answers, and for each key the trials in which that key is right.
struct Score {
  double trials = 0, right = 0;
  Shares keys{};

  void add(const Score& other, double times) {
    trials += times * other.trials, right += times * other.right;
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] += times * other.keys[i];
  }
  bool operator==(const Score&) const = default;
  double accuracy() const { return trials > 0 ? right / trials : 0; }
  std::size_t best_key() const {
    return static_cast<std::size_t>(std::max_element(keys.begin(), keys.end()) - keys.begin());
  }
  double one_key() const { return trials > 0 ? keys[best_key()] / trials : 0; }
};

Score sum_of(const std::vector<Score>& sessions);

/// Computes two standard errors from the scores of several sessions: of the proportion correct, and of its
/// gain over always pressing one key. Returns the larger. Returns 0 without trials.
double standard_error(const std::vector<Score>& sessions);

}  // namespace turnpoint::rehearsal
