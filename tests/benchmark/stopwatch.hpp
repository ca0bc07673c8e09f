#pragma once
#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

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

/// One of several pieces of work that are compared with each other.
struct Work {
  std::string name;
  std::function<void()> run;
};

/// The processor time of a Work, and its ratio to that of the first Work (the baseline) in the same repeat.
struct Compared {
  std::string name;
  double time_s = 0, ratio = 0;  ///< medians over the repeats
  double lowest_ratio = 0, highest_ratio = 0;
};

/// Compares the processor time of all works with that of the first. They take turns, and time during which
/// other programs run is not counted, so that the ratios are meaningful on a busy machine. All work must be
/// done on the calling thread. `repeats` is at least 1.
std::vector<Compared> compare(const std::vector<Work>& works, int repeats);

}  // namespace turnpoint::benchmark
