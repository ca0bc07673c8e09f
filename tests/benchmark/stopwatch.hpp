#pragma once
#include <algorithm>
#include <chrono>
#include <limits>

namespace turnpoint::benchmark {

/// Runs `work` at least twice and until the budget (s) is used up. Returns the shortest time (s).
template <class Work>
double best_time(double budget_s, Work work) {
  using clock = std::chrono::steady_clock;
  double best = std::numeric_limits<double>::infinity(), spent = 0;
  for (int i = 0; i < 2 || (spent < budget_s && i < 1000); ++i) {
    const auto start = clock::now();
    work();
    const double took = std::chrono::duration<double>(clock::now() - start).count();
    best = std::min(best, took);
    spent += took;
  }
  return best;
}

}  // namespace turnpoint::benchmark
