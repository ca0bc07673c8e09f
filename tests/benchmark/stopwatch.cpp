#include "tests/benchmark/stopwatch.hpp"

#include <ctime>

#include "station/analysis/quantile.hpp"

namespace turnpoint::benchmark {

namespace {

double processor_time_s(const std::function<void()>& work) {
  const auto now_s = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  const double start_s = now_s();
  work();
  return now_s() - start_s;
}

}  // namespace

std::vector<Compared> compare(const std::vector<Work>& works, int repeats) {
  std::vector<std::vector<double>> times_s(works.size()), ratios(works.size());
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t w = 0; w < works.size(); ++w) {
      times_s[w].push_back(processor_time_s(works[w].run));
      ratios[w].push_back(times_s[w].back() / times_s.front().back());
    }
  std::vector<Compared> compared;
  for (std::size_t w = 0; w < works.size(); ++w)
    compared.push_back({works[w].name, analysis::quantile(times_s[w], 0.5),
                        analysis::quantile(ratios[w], 0.5), std::ranges::min(ratios[w]),
                        std::ranges::max(ratios[w])});
  return compared;
}

}  // namespace turnpoint::benchmark
