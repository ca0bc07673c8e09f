#include "station/simulation/first_passage.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "tests/support/catch.hpp"

using namespace turnpoint;
using simulation::first_passage;

namespace {

struct Row {
  double time, upper;
};

/// Returns the table of make_first_passage.py: for each drift and start, and with bound 1, the probability
/// that the walk has reached the upper boundary by a given time.
std::map<std::pair<double, double>, std::vector<Row>> oracle() {
  std::ifstream file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/simulation/first_passage.csv");
  std::map<std::pair<double, double>, std::vector<Row>> table;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    double drift = 0, start = 0;
    Row row{};
    char comma = 0;
    cells >> drift >> comma >> start >> comma >> row.time >> comma >> row.upper;
    table[{drift, start}].push_back(row);
  }
  return table;
}

/// Returns the largest deviation of 200 000 draws from any row of the table, in standard errors.
double distance(double drift, double start, const std::vector<Row>& rows) {
  core::Draws draws({17, core::Stream::observer, 0, 0, 0});
  const int n = 200'000;
  const double bound = 0.7;  // the table has bound 1; times grow with the square of the bound
  std::vector<int> counts(rows.size());
  for (int i = 0; i < n; ++i) {
    const auto passage = first_passage(drift / bound, bound, start, draws);
    for (std::size_t r = 0; r < rows.size(); ++r)
      counts[r] += passage.upper && passage.time_s <= rows[r].time * bound * bound;
  }
  double largest = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double p = rows[r].upper, error = std::sqrt(std::max(p * (1 - p), 1e-5) / n);
    largest = std::max(largest, std::fabs(counts[r] / static_cast<double>(n) - p) / error);
  }
  return largest;
}

}  // namespace

TEST_CASE("first passages have the distribution of the known series", "[observer]") {
  const auto table = oracle();
  REQUIRE(table.size() == 10);
  for (const auto& [at, rows] : table) {
    INFO("drift " << at.first << ", start " << at.second);
    CHECK(distance(at.first, at.second, rows) < 4.5);
  }
}

TEST_CASE("negative control: the comparison with the series detects a drift or a start that is 3 % off",
          "[observer]") {
  const auto table = oracle();
  CHECK(distance(0.9 * 1.03, 0, table.at({0.9, 0.0})) > 4.5);
  CHECK(distance(0.9, 0.03, table.at({0.9, 0.0})) > 4.5);
}

TEST_CASE("accuracy and mean time agree with Palmer, Huk and Shadlen", "[observer]") {
  // For normalised bound A' = .85, sensitivity k = 9 and stimulus strength x = .1, their formulas give a mean
  // decision time of .60823 s. With the residual time tR = .35 s, the whole response takes .95823 s.
  CHECK(simulation::upper_probability(0.9, 0.85) == Approx(0.82201).margin(1e-5));
  CHECK(simulation::upper_probability(0, 0.85) == 0.5);
  core::Draws draws({3, core::Stream::observer, 0, 0, 0});
  const int n = 200'000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double time = first_passage(0.9, 0.85, 0, draws).time_s;
    sum += time, squares += time * time;
  }
  const double sd = std::sqrt(squares / n - sum * sum / n / n);
  CHECK(sum / n + 0.35 == Approx(0.95823).margin(4 * sd / std::sqrt(n)));
}

TEST_CASE("a starting point off the middle changes the accuracy as the closed form says", "[observer]") {
  core::Draws draws({4, core::Stream::observer, 0, 0, 0});
  const int n = 100'000;
  for (const double drift : {-0.8, 0.0, 0.8}) {
    int upper = 0;
    for (int i = 0; i < n; ++i)
      upper += first_passage(drift, 1, 0.6 * (2 * draws.uniform() - 1), draws).upper;
    const double p = simulation::upper_probability(drift, 1, 0.6);
    CHECK(upper / static_cast<double>(n) == Approx(p).margin(4 * std::sqrt(p * (1 - p) / n)));
  }
  CHECK(simulation::upper_probability(0.8, 1, 0.6) < simulation::upper_probability(0.8, 1) - 0.01);
}

TEST_CASE("a passage is found for any drift and bound", "[observer]") {
  core::Draws draws({5, core::Stream::observer, 0, 0, 0});
  for (const double drift : {-1e12, -1.0, 0.0, 1e-12, 40.0, 1e12})
    for (const double bound : {1e-3, 1.0, 50.0}) {
      const auto passage = first_passage(drift, bound, 0, draws);
      CHECK((std::isfinite(passage.time_s) && passage.time_s > 0));
      if (std::fabs(drift * bound) > 100) CHECK(passage.upper == (drift > 0));
    }
}

namespace {

/// Computes the probability that a walk has left at +1 or is above 0 at `time`, by explicit finite
/// differences of the Fokker-Planck equation dp/dt = -drift dp/dx + 1/2 d2p/dx2 between absorbing boundaries.
double upper_by_differences(double drift, double time) {
  constexpr int n = 200;  // cells from -1 to 1
  const double h = 2.0 / n;
  const int steps = static_cast<int>(std::ceil(time / (0.4 * h * h)));
  const double dt = time / steps;
  std::vector<double> p(n + 1, 0.0), next(n + 1, 0.0);
  p[n / 2] = 1 / h;
  double upper = 0;
  for (int step = 0; step < steps; ++step) {
    for (int i = 1; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      next[k] = p[k] + dt * (0.5 * (p[k + 1] - 2 * p[k] + p[k - 1]) / (h * h) -
                             drift * (p[k + 1] - p[k - 1]) / (2 * h));
    }
    // the flux through +1, from a one-sided difference of second order
    upper += dt * 0.5 * (4 * p[n - 1] - p[n - 2]) / (2 * h);
    std::swap(p, next);
  }
  double above = 0.5 * p[n / 2] * h;
  for (std::size_t k = n / 2 + 1; k < n; ++k) above += p[k] * h;
  return upper + above;
}

}  // namespace

TEST_CASE("what a walk says at a signal agrees with finite differences of its density", "[observer]") {
  for (const double drift : {0.0, 0.4, 1.5, -1.5, 4.0})
    for (const double time : {0.02, 0.1, 0.5, 2.0}) {
      CAPTURE(drift, time);
      CHECK(simulation::upper_by(drift, 1, time) == Approx(upper_by_differences(drift, time)).margin(2e-3));
      CHECK(simulation::upper_by(drift / 0.7, 0.7, time * 0.49) ==
            Approx(simulation::upper_by(drift, 1, time)).margin(1e-12));
    }
  CHECK(simulation::upper_by(2, 1, 0) == 0.5);
  CHECK(simulation::upper_by(2, 1, 1e-9) == Approx(0.5).margin(1e-3));
  CHECK(simulation::upper_by(2, 1, 50) == Approx(simulation::upper_probability(2, 1)).margin(1e-12));
  CHECK(simulation::upper_by(1e6, 1, 1) == 1);
}
