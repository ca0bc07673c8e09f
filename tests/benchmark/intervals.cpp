#include "tests/benchmark/intervals.hpp"

#include <cmath>
#include <string>

#include "station/analysis/psychometric_posterior.hpp"
#include "tests/benchmark/stopwatch.hpp"

namespace turnpoint::benchmark {

namespace {

constexpr double kBudget_s = 0.5;
constexpr int kReplicates = 1000, kBandPoints = 61;

/// Returns the expected answers in `trials` trials on 28 levels around a threshold of -18 dB, for a Weibull
/// function of slope 2.
std::vector<analysis::LevelCount> answers(int trials) {
  std::vector<analysis::LevelCount> data;
  for (int level = -30; level <= -3; ++level) {
    const double near = std::exp(-0.5 * std::pow((level + 17) / 5.0, 2));
    const int count = 1 + static_cast<int>(std::lround(near * trials / 12.5));
    const double p =
        analysis::probability(core::Function::weibull, analysis::Scale::linear, {-18, 2, 0.5, 0.02}, level);
    data.push_back({static_cast<double>(level), count, static_cast<int>(std::lround(count * p))});
  }
  return data;
}

}  // namespace

Report bench_intervals() {
  Report report;
  report.name = "intervals";
  report.title = "95 % intervals of a psychometric function on 28 levels; the bootstrap has 1000 replicates";
  report.table.columns = {"trials", "posterior_ms", "bootstrap_ms", "ratio"};
  const auto prior = analysis::prior_around(core::Function::weibull, analysis::Scale::linear, {-30, -3}, {});
  for (const int wanted : {48, 96, 200}) {
    const auto data = answers(wanted);
    int trials = 0;
    for (const auto& point : data) trials += point.trials;
    const double posterior =
        best_time(kBudget_s, [&] { analysis::fit_posterior(data, {}, prior, kBandPoints); });
    const double bootstrap = best_time(kBudget_s, [&] {
      analysis::bootstrap(analysis::fit_psychometric(data, {}), {kReplicates, 0.95, 1, 0, kBandPoints});
    });
    report.table.rows.push_back(
        {static_cast<double>(trials), posterior * 1e3, bootstrap * 1e3, bootstrap / posterior});
  }
  return report;
}

}  // namespace turnpoint::benchmark
