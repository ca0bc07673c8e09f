#include "tests/benchmark/scipy.hpp"

#include <fmt/format.h>

#include <sstream>

#include "tests/benchmark/scripts.hpp"

namespace turnpoint::benchmark {

namespace {

/// Returns the numbers of the problem in full precision, as command-line arguments for peers/one_mode.py.
std::vector<std::string> arguments_of(const OneModeProblem& p) {
  std::vector<std::string> list;
  for (const double value :
       {p.k_squared.real(), p.k_squared.imag(), p.b, p.c, p.w0, p.slope, p.decay_m, p.length_m,
        static_cast<double>(p.x_m.size()), p.wedge() ? p.bessel_order() : 0.0})
    list.push_back(fmt::format("{}", value));
  return list;
}

}  // namespace

std::vector<ScipyRun> run_scipy(const OneModeProblem& problem) {
  std::vector<ScipyRun> runs;
  for (const auto& line : run_peer("one_mode.py", arguments_of(problem))) {
    std::istringstream stream(line);
    ScipyRun run;
    std::string seconds, values;
    if (!std::getline(stream, run.name, ';') || !std::getline(stream, run.setting, ';') ||
        !std::getline(stream, seconds, ';') || !std::getline(stream, values))
      continue;
    run.seconds = std::stod(seconds);
    std::istringstream list(values);
    for (double re = 0, im = 0; list >> re >> im;) run.v.emplace_back(re, im);
    if (run.v.size() == problem.x_m.size()) runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace turnpoint::benchmark
