// Tests the diffusion model of speed and accuracy: its likelihood against mpmath, its fit against data of an
// exact sampler that shares no code with the likelihood.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "station/analysis/diffusion.hpp"
#include "station/analysis/first_passage.hpp"
#include "station/analysis/group.hpp"
#include "station/analysis/quantile.hpp"
#include "station/analysis/trade.hpp"
#include "tests/analysis/first_passage_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/diffusion.hpp"
#include "tests/support/number_from.hpp"

using namespace turnpoint::analysis;
using turnpoint::tests::sample_decision;
namespace rnd = turnpoint::core;

namespace {

using Decided = DiffusionTrial::Outcome;

/// One kind of data set: two conditions with boundaries 0.09 and 0.16, Ter 0.35 s, and three difficulties.
struct Cell {
  const char* name;
  std::array<int, 3> speed, accuracy;        ///< trials of each difficulty
  double speed_deadline, accuracy_deadline;  ///< 0: none
  double lapses, slow;  ///< shares of random answers, and of answers that come 0.5 to 2 s later
};
// These cells and the limits of the test below were written down before the first run.
constexpr Cell kCells[] = {
    {"clean, 56 a difficulty", {56, 56, 56}, {56, 56, 56}, 0, 0, 0, 0},
    {"deadline 0.6 s on speed", {56, 56, 56}, {56, 56, 56}, 0.6, 0, 0, 0},
    {"deadlines 0.6 and 1 s", {56, 56, 56}, {56, 56, 56}, 0.6, 1.0, 0, 0},
    {"2 % lapses, 3 % slow", {56, 56, 56}, {56, 56, 56}, 0, 0, 0.02, 0.03},
    {"lapses, slow, deadlines", {56, 56, 56}, {56, 56, 56}, 0.6, 1.2, 0.02, 0.03},
    {"24 a difficulty", {24, 24, 24}, {24, 24, 24}, 0, 0, 0, 0},
    {"24, deadline 0.7 s", {24, 24, 24}, {24, 24, 24}, 0.7, 0, 0, 0},
    {"200 a difficulty", {200, 200, 200}, {200, 200, 200}, 0, 0, 0, 0},
    {"200, lapses, slow", {200, 200, 200}, {200, 200, 200}, 0, 0, 0.02, 0.03},
    {"unequal numbers", {120, 56, 24}, {24, 56, 120}, 0, 0, 0, 0},
};
constexpr double kDrifts[] = {0.10, 0.20, 0.32}, kSpeed = 0.09, kAccuracy = 0.16, kTer = 0.35;

/// One trial of a person with these parameters and the lapses and slow answers of a cell.
DiffusionTrial one_trial(const DiffusionParameters& truth, std::size_t difficulty, double deadline_s,
                         const Cell& cell, rnd::Draws& draws) {
  const auto decision = sample_decision(truth, draws);
  DiffusionTrial trial{difficulty, Decided::answered, decision.correct, decision.time_s, {}};
  const double what = draws.uniform();
  if (what < cell.lapses) {
    trial.correct = draws.uniform() < 0.5;
    trial.time_s = draws.uniform(0.1, deadline_s > 0 ? deadline_s : 2.0);
  } else if (what < cell.lapses + cell.slow) {
    trial.time_s += draws.uniform(0.5, 2.0);
  }
  if (deadline_s > 0) trial.deadline_s = deadline_s;
  if (deadline_s > 0 && trial.time_s > deadline_s) trial.outcome = Decided::late, trial.time_s = deadline_s;
  return trial;
}

std::vector<DiffusionTrial> simulated(double boundary, double deadline_s, const Cell& cell,
                                      const std::array<int, 3>& trials, rnd::Draws& draws) {
  std::vector<DiffusionTrial> all;
  for (std::size_t k = 0; k < trials.size(); ++k)
    for (int i = 0; i < trials[k]; ++i)
      all.push_back(one_trial({kDrifts[k], boundary, kTer}, k, deadline_s, cell, draws));
  return all;
}

bool holds(const Interval& interval, double value) { return interval.low <= value && value <= interval.high; }

/// How often the intervals of a cell hold the truth: boundary, Ter and the three drifts of both conditions,
/// and the differences of boundary, Ter and mean drift.
struct Coverage {
  std::array<int, 13> held{};
  int sets = 0, without = 0;
  std::vector<double> widths_boundary, widths_ter;

  double share(std::size_t i) const { return static_cast<double>(held[i]) / std::max(sets, 1); }
};

Coverage coverage(std::size_t index, int sets, int first) {
  const auto& cell = kCells[index];
  Coverage result;
  for (int set = first; set < first + sets; ++set) {
    rnd::Draws draws({91, rnd::Stream::observer, static_cast<int>(index), 0, set});
    const auto speed_trials = simulated(kSpeed, cell.speed_deadline, cell, cell.speed, draws);
    const auto accuracy_trials = simulated(kAccuracy, cell.accuracy_deadline, cell, cell.accuracy, draws);
    const auto speed = fit_diffusion(speed_trials, 3, static_cast<std::uint64_t>(set), 1).estimates,
               accuracy = fit_diffusion(accuracy_trials, 3, static_cast<std::uint64_t>(set), 2).estimates;
    if (!speed || !accuracy) {
      ++result.without;
      continue;
    }
    ++result.sets;
    std::size_t next = 0;
    const auto add = [&](const Interval& interval, double truth) {
      result.held[next++] += holds(interval, truth);
    };
    for (const auto& [found, boundary] : {std::pair{&*speed, kSpeed}, {&*accuracy, kAccuracy}}) {
      add(found->boundary.interval, boundary);
      add(found->nondecision_s.interval, kTer);
      for (std::size_t k = 0; k < 3; ++k) add(found->drift[k].interval, kDrifts[k]);
    }
    std::vector<double> boundary, ter, drift;
    for (std::size_t i = 0; i < speed->draws.size(); ++i) {
      const auto &a = speed->draws[i], &b = accuracy->draws[i];
      boundary.push_back(b.boundary - a.boundary);
      ter.push_back(b.nondecision_s - a.nondecision_s);
      drift.push_back(mean(b.drift) - mean(a.drift));
    }
    const auto of_boundary = percentile_interval(boundary), of_ter = percentile_interval(ter);
    add(of_boundary, kAccuracy - kSpeed);
    add(of_ter, 0);
    add(percentile_interval(drift), 0);
    result.widths_boundary.push_back(of_boundary.high - of_boundary.low);
    result.widths_ter.push_back(of_ter.high - of_ter.low);
  }
  return result;
}

}  // namespace

namespace {

double log_density(const Diffusion& diffusion, bool upper, double time_s) {
  return FirstPassageDensity(diffusion, upper).log_at(time_s);
}

}  // namespace

TEST_CASE("The first-passage density, distribution, tail and survival agree with mpmath",
          "[analysis][diffusion]") {
  const auto compare = [](double computed, double exact) {
    if (exact < -1e5) {
      CHECK(computed < -9e4);
      return;
    }
    // relative error of the value, and below 1e-30 of its logarithm
    CHECK(std::fabs(computed - exact) < (exact > -69 ? 1e-8 : 1e-6 * std::fabs(exact)));
  };
  for (const auto& [drift, boundary, start, time, density, distribution, tail, survival] :
       turnpoint::tests::kFirstPassage) {
    INFO("drift " << drift << ", boundary " << boundary << ", start " << start << ", time " << time);
    const Diffusion lower{drift, boundary, start}, upper{-drift, boundary, 1 - start};
    compare(log_density(lower, false, time), density);
    compare(log_distribution(lower, false, time), distribution);
    compare(log_tail(lower, false, time), tail);
    compare(log_survival(lower, time), survival);
    if (start == 0.5) CHECK(log_density(upper, true, time) == log_density(lower, false, time));
  }
}

TEST_CASE("With variability of drift and delay, the first-passage functions agree with quadrature in mpmath",
          "[analysis][diffusion]") {
  std::vector<std::array<double, 10>> rows;
  for (const auto& row : turnpoint::tests::kFirstPassageVaried)
    std::copy_n(row, 10, rows.emplace_back().begin());
  if (const char* more = std::getenv("TURNPOINT_VARIED_ROWS")) {
    std::ifstream file(more);
    for (std::string line; std::getline(file, line);) {
      std::replace_if(
          line.begin(), line.end(), [](char c) { return c == ',' || c == '{' || c == '}'; }, ' ');
      std::istringstream words(line);
      for (auto& number : rows.emplace_back()) words >> number;
      REQUIRE(words);
    }
    std::cout << rows.size() << " sets\n";
  }
  double worst = 0;
  for (const auto& [drift, boundary, start, time, sd, delay, density, distribution, tail, survival] : rows) {
    INFO("drift " << drift << ", boundary " << boundary << ", start " << start << ", time " << time << ", sd "
                  << sd << ", delay " << delay);
    const Diffusion lower{drift, boundary, start, sd, delay};
    const auto compare = [&worst](double computed, double exact) {
      const double error = std::fabs(computed - exact);
      if (exact > -69) worst = std::max(worst, error);
      CHECK(error < (exact > -69 ? 1e-8 : 1e-6 * std::fabs(exact)));
    };
    compare(log_density(lower, false, time), density);
    compare(log_distribution(lower, false, time), distribution);
    compare(log_tail(lower, false, time), tail);
    compare(log_survival(lower, time), survival);
    // negative control: half as much variability is something else
    const Diffusion less{drift, boundary, start, sd / 2, delay / 2};
    if (rows.size() == 19) CHECK(std::fabs(log_density(less, false, time) - density) > 1e-7);
  }
  if (rows.size() > 19) std::cout << "largest relative error above 1e-30: " << worst << '\n';
}

TEST_CASE("The first-passage functions are never NaN, and agree with each other", "[analysis][diffusion]") {
  for (const double drift : {-30.0, -1.0, -1e-9, 0.0, 1e-300, 0.3, 5.0, 30.0})
    for (const double boundary : {0.05, 0.5, 1.0, 10.0})
      for (const double start : {1e-6, 0.1, 0.5, 0.9, 1 - 1e-6})
        for (const double time : {-1.0, 0.0, 1e-300, 1e-4, 0.01, 0.3, 2.0, 100.0}) {
          INFO("drift " << drift << ", boundary " << boundary << ", start " << start << ", time " << time);
          const Diffusion d{drift, boundary, start};
          for (const bool upper : {false, true}) {
            CHECK_FALSE(std::isnan(log_density(d, upper, time)));
            const double below = log_distribution(d, upper, time), above = log_tail(d, upper, time);
            CHECK_FALSE(std::isnan(below));
            CHECK_FALSE(std::isnan(above));
            const double ever = upper ? upper_probability(d) : 1 - upper_probability(d);
            CHECK(std::exp(below) + std::exp(above) == Approx(ever).margin(1e-12));
          }
          CHECK(log_survival(d, time) <= 0);
        }
}

TEST_CASE("With any variability the functions are never NaN, and distribution and tail make the whole",
          "[analysis][diffusion]") {
  for (const double drift : {-30.0, 0.0, 5.0})
    for (const double boundary : {0.05, 1.0, 10.0})
      for (const double start : {1e-6, 0.5, 1 - 1e-6})
        for (const double sd : {0.0, 0.3, 20.0})
          for (const double delay : {0.0, 1e-4, 0.5})
            for (const double time : {1e-4, 0.3, 100.0}) {
              if (sd == 0 && delay == 0) continue;
              INFO("drift " << drift << ", boundary " << boundary << ", start " << start << ", sd " << sd
                            << ", delay " << delay << ", time " << time);
              const Diffusion d{drift, boundary, start, sd, delay};
              const double ever = upper_probability(d);
              const double below = log_distribution(d, true, time), above = log_tail(d, true, time);
              CHECK_FALSE(std::isnan(log_density(d, true, time)));
              CHECK(std::exp(below) + std::exp(above) == Approx(ever).epsilon(1e-8).margin(1e-300));
              const Diffusion turned{-drift, boundary, 1 - start, sd, delay};
              CHECK(ever + upper_probability(turned) == Approx(1).epsilon(1e-8));
            }
}

TEST_CASE("EZ-diffusion, the start of the fit, reproduces the example of its paper",
          "[analysis][diffusion]") {
  const auto ez = ez_diffusion(0.802, 100, 0.723, 0.112);
  REQUIRE(ez);
  CHECK(ez->drift == Approx(0.0999385).margin(5e-8));
  CHECK(ez->boundary == Approx(0.1399702).margin(5e-8));
  CHECK(ez->nondecision_s == Approx(0.3000300).margin(5e-8));
  CHECK_FALSE(ez_diffusion(0, 50, 0.7, 0.1));
  CHECK_FALSE(ez_diffusion(0.8, 50, 0.7, 0));
  CHECK_FALSE(ez_diffusion(0.8, 50, 0.3, 1.0));
}

// TURNPOINT_DIFFUSION_SETS=2000 tries every cell with as many data sets and prints its shares;
// TURNPOINT_DIFFUSION_FIRST=2000 begins at that number, so that a run can be made in parts, and
// TURNPOINT_DIFFUSION_CELL=3 takes one cell.
TEST_CASE(
    "The intervals of the diffusion's parameters and of their differences hold the truth as often as they "
    "say",
    "[analysis][diffusion]") {
  const int sets = number_from("TURNPOINT_DIFFUSION_SETS", 0),
            first = number_from("TURNPOINT_DIFFUSION_FIRST", 0),
            only = number_from("TURNPOINT_DIFFUSION_CELL", -1);
  if (sets == 0) {  // a deadline that cuts off a quarter of the answers; without censoring the boundary is
                    // covered in 0 %
    const auto found = coverage(1, 80, 0);
    CHECK(found.without == 0);
    for (std::size_t i = 0; i < found.held.size(); ++i) {
      INFO("number " << i);
      CHECK(found.share(i) > 0.87);  // of 80 sets that are covered in 95 %, fewer than 88 % in 1 of 250 runs
    }
    return;
  }
  double sum = 0;
  int shares = 0;
  for (std::size_t index = 0; index < std::size(kCells); ++index) {
    if (only >= 0 && index != static_cast<std::size_t>(only)) continue;
    const auto found = coverage(index, sets, first);
    std::cout << kCells[index].name << ":";
    for (std::size_t i = 0; i < found.held.size(); ++i) {
      std::cout << ' ' << std::round(1000 * found.share(i)) / 10;
      sum += found.share(i), ++shares;
      CHECK(found.share(i) > 0.92);
      CHECK(found.share(i) < 0.98);
    }
    std::cout << "; widths " << quantile(found.widths_boundary, 0.5) << ", "
              << quantile(found.widths_ter, 0.5) << " s; without a fit " << found.without << '\n';
  }
  std::cout << "mean " << 100 * sum / shares << " %\n";
  CHECK(sum / shares > 0.935);
  CHECK(sum / shares < 0.965);
}

TEST_CASE("Trimmed times and dropped late answers are what broke the intervals: the fit takes all trials",
          "[analysis][diffusion]") {
  // Negative control: with the late answers left out, the boundary of the speed condition is far too low.
  rnd::Draws draws({4, rnd::Stream::observer, 0, 0, 0});
  auto trials = simulated(kSpeed, 0.5, kCells[7], kCells[7].speed, draws);
  const auto all = fit_diffusion(trials, 3, 1, 1).estimates;
  std::erase_if(trials, [](const auto& trial) { return trial.outcome == Decided::late; });
  for (auto& trial : trials) trial.deadline_s.reset();
  const auto answered = fit_diffusion(trials, 3, 1, 1).estimates;
  REQUIRE((all && answered));
  CHECK(holds(all->boundary.interval, kSpeed));
  CHECK(answered->boundary.interval.high < kSpeed);
}

TEST_CASE("Caution that wears off within a block is found, and blocks that differ do not look like it",
          "[analysis][diffusion]") {
  for (const bool wears_off : {true, false}) {
    rnd::Draws draws({9, rnd::Stream::observer, 0, 0, 0});
    std::vector<TrialRecord> trials;
    for (int i = 0; i < 480; ++i) {
      const int block = i / 120;
      const bool late = i % 120 >= 60;
      const double boundary = wears_off ? (late ? 0.09 : 0.15) : (block % 2 == 0 ? 0.09 : 0.15);
      const auto decision = sample_decision({0.2, boundary, kTer}, draws);
      TrialRecord trial;
      trial.trial_index = i, trial.block_index = block;
      trial.difficulty = 1, trial.correct = decision.correct, trial.response_time_s = decision.time_s;
      trials.push_back(trial);
    }
    TradeOptions options;
    options.replicates = 20;
    CHECK_FALSE(trade(trials, options).instructions.front().late_boundary);
    options.halves = true;
    const auto found = trade(trials, options).instructions.front().late_boundary;
    REQUIRE(found);
    if (wears_off) CHECK(found->interval.high < -0.03);
    CHECK(holds(found->interval, wears_off ? -0.06 : 0));
  }
}

TEST_CASE(
    "A person who is always right, always wrong, or answers at one time has finite intervals or a reason",
    "[analysis][diffusion]") {
  rnd::Draws draws({6, rnd::Stream::observer, 0, 0, 0});
  const auto data = simulated(kAccuracy, 0, kCells[0], kCells[0].accuracy, draws);
  for (int kind = 0; kind < 5; ++kind) {
    auto trials = data;
    for (auto& trial : trials) {
      if (kind == 0) trial.correct = true;
      if (kind == 1) trial.correct = false;
      if (kind == 2) trial.time_s = 0.5;
      if (kind == 3) trial.outcome = Decided::late, trial.time_s = 1;
      if (kind == 4) trial.time_s = 1e-3;
    }
    const auto fit = fit_diffusion(trials, 3, 1, 1);
    INFO("kind " << kind);
    CHECK(fit.estimates.has_value() == fit.statements.empty());
    if (fit.estimates)
      for (const auto& one :
           {fit.estimates->boundary, fit.estimates->nondecision_s, fit.estimates->drift[0]}) {
        CHECK(std::isfinite(one.value));
        CHECK(std::isfinite(one.interval.low));
        CHECK(std::isfinite(one.interval.high));
      }
    if (kind == 3) CHECK_FALSE(fit.estimates);
  }
}

namespace {

/// Processes that make answers, for a check that must find those that are not a diffusion.
enum class Process { diffusion, deadline, contaminants, collapsing, race, guesses };
constexpr const char* kProcesses[] = {"diffusion",
                                      "diffusion, deadlines of 0.6 and 1 s",
                                      "diffusion, 2 % lapses and 3 % slow answers",
                                      "boundaries that collapse",
                                      "a race of two accumulators",
                                      "20 % guesses"};

/// A decision between boundaries that come to a fifth of their distance with time: steps of 1 ms.
turnpoint::tests::Decision collapsing_decision(double drift, double boundary, rnd::Draws& draws) {
  double x = 0, time_s = 0;
  constexpr double step_s = 1e-3;
  while (true) {
    x += drift * step_s + kDiffusionScale * std::sqrt(step_s) * draws.normal();
    time_s += step_s;
    const double half = 0.75 * boundary * (1 - 0.8 * time_s / (time_s + 0.35));
    if (std::fabs(x) >= half) return {x > 0, time_s + kTer};
  }
}

/// A race of two accumulators with ballistic growth (Brown & Heathcote 2008).
turnpoint::tests::Decision race_decision(double advantage, double threshold, rnd::Draws& draws) {
  double times_s[2];
  for (int which = 0; which < 2; ++which) {
    double rate = 0;
    while (rate <= 0.05) rate = 1.0 + (which == 1 ? advantage : -advantage) + 0.35 * draws.normal();
    times_s[which] = (threshold - draws.uniform(0, 0.3)) / rate;
  }
  return {times_s[1] < times_s[0], std::min(times_s[0], times_s[1]) + 0.2};
}

std::vector<DiffusionTrial> answers_of(Process process, bool fast, int per_difficulty, rnd::Draws& draws) {
  const double boundary = fast ? kSpeed : kAccuracy;
  const double deadline_s = process == Process::deadline ? (fast ? 0.6 : 1.0) : 0;
  const Cell cell{"",
                  {},
                  {},
                  0,
                  0,
                  process == Process::contaminants ? 0.02 : 0.0,
                  process == Process::contaminants ? 0.03 : 0.0};
  auto trials =
      simulated(boundary, deadline_s, cell, {per_difficulty, per_difficulty, per_difficulty}, draws);
  for (auto& trial : trials) {
    turnpoint::tests::Decision decision{trial.correct, trial.time_s};
    if (process == Process::collapsing)
      decision = collapsing_decision(kDrifts[trial.difficulty], boundary, draws);
    if (process == Process::race)
      decision = race_decision(0.8 * kDrifts[trial.difficulty], fast ? 0.35 : 0.6, draws);
    if (process == Process::guesses && draws.uniform() < 0.2)
      decision = {draws.uniform() < 0.5, draws.uniform(0.2, 0.8)};
    trial.correct = decision.correct, trial.time_s = decision.time_s;
  }
  return trials;
}

/// The share of sessions of two conditions with three difficulties that the check flags.
double flagged(Process process, int per_difficulty, int sets, int first) {
  int bad = 0;
  for (int set = first; set < first + sets; ++set) {
    rnd::Draws draws({92, rnd::Stream::observer, static_cast<int>(process), per_difficulty, set});
    std::vector<DiffusionCheck> checks;
    for (const bool fast : {true, false}) {
      const auto trials = answers_of(process, fast, per_difficulty, draws);
      if (const auto fit = fit_diffusion(trials, 3, static_cast<std::uint64_t>(set), fast ? 1 : 2).estimates)
        checks.push_back(check_diffusion(trials, *fit, static_cast<std::uint64_t>(set), fast ? 1 : 2));
    }
    std::vector<const DiffusionCheck*> both;
    for (const auto& check : checks) both.push_back(&check);
    const auto p = share_as_bad(both);
    bad += p && *p < 0.05;
  }
  return static_cast<double>(bad) / sets;
}

}  // namespace

// TURNPOINT_CHECK_SETS=400 prints the shares for every process and number of trials;
// TURNPOINT_CHECK_PROCESS=3 takes one process.
TEST_CASE("The check of the diffusion model seldom flags a diffusion, and flags other processes",
          "[analysis][diffusion]") {
  const int sets = number_from("TURNPOINT_CHECK_SETS", 0), only = number_from("TURNPOINT_CHECK_PROCESS", -1);
  if (sets == 0) {
    CHECK(flagged(Process::deadline, 56, 12, 0) <= 0.3);  // 4 or more of 12 at 5 %: 1 in 450 runs
    CHECK(flagged(Process::collapsing, 400, 3, 0) >= 0.6);
    return;
  }
  for (std::size_t process = 0; process < std::size(kProcesses); ++process) {
    if (only >= 0 && process != static_cast<std::size_t>(only)) continue;
    for (const int per_difficulty : {56, 200}) {
      const double share = flagged(static_cast<Process>(process), per_difficulty, sets, 0);
      std::cout << kProcesses[process] << ", " << per_difficulty << " a difficulty: flagged " << 100 * share
                << " %" << std::endl;
      if (process < 3) CHECK(share <= 0.06 + 3 * std::sqrt(0.06 * 0.94 / sets));
    }
  }
}

TEST_CASE("What the check predicts is what the model's own samples show", "[analysis][diffusion]") {
  rnd::Draws draws({8, rnd::Stream::observer, 0, 0, 0});
  const auto trials = simulated(kAccuracy, 0.9, kCells[0], {4000, 4000, 4000}, draws);
  DiffusionEstimates truth;
  truth.boundary.value = kAccuracy, truth.nondecision_s.value = kTer, truth.start = {0.5, {0.5, 0.5, 0.95}};
  for (const double drift : kDrifts) truth.drift.push_back({drift, {}});
  const auto check = check_diffusion(trials, truth, 1, 1);
  REQUIRE(check.difficulties.size() == 3);
  for (const auto& [right, wrong] : check.difficulties)
    for (const auto* answers : {&right, &wrong}) {
      CHECK(answers->observed / 4000.0 == Approx(answers->probability).margin(0.03));
      if (answers->observed < 300) continue;  // quantiles of few answers are uncertain
      CHECK(*answers->observed_mean_s == Approx(answers->mean_s).margin(0.02));
      for (std::size_t q = 0; q < kPredictedQuantiles.size(); ++q)
        CHECK(answers->observed_quantiles[q].value == Approx(answers->quantile_s[q]).margin(0.03));
    }
  CHECK(*share_as_bad({&check}) > 0.001);
  truth.boundary.value = 1.3 * kAccuracy;  // a prediction of something else
  const auto other = check_diffusion(trials, truth, 1, 1);
  CHECK(std::fabs(other.difficulties[0].right.observed / 4000.0 - other.difficulties[0].right.probability) >
        0.03);
}

namespace {

/// How often the group's effects of a condition hold the truth, and how often one is claimed that is not
/// there.
struct GroupShares {
  std::array<int, 3> held{}, claimed{};  // boundary, time outside the decision, drift
  int studies = 0;
};

/// People differ in everything, and in how the condition acts on them. Its mean effect is 0.06 on the
/// boundary and 0 on the rest. 40 trials of each of three difficulties and condition, a deadline of 0.8 s in
/// the speed blocks, 2 % lapses, 2 % slow answers.
GroupShares group_shares(int people, int studies, int first) {
  constexpr const char* kMeasures[] = {"boundary", "time outside the decision", "drift"};
  constexpr double kEffects[] = {0.06, 0, 0};
  const Cell cell{"", {}, {}, 0, 0, 0.02, 0.02};
  GroupShares shares;
  for (int study = first; study < first + studies; ++study) {
    rnd::Draws draws({93, rnd::Stream::observer, people, 0, study});
    std::vector<PersonMeasure> measures;
    for (int person = 0; person < people; ++person) {
      const double boundary = 0.09 + 0.012 * draws.normal(), more = 0.06 + 0.015 * draws.normal();
      const double ter_s = 0.35 + 0.04 * draws.normal(), later_s = 0.015 * draws.normal();
      const double talent = std::exp(0.2 * draws.normal()), better = 0.02 * draws.normal();
      for (const bool fast : {true, false}) {
        std::vector<DiffusionTrial> trials;
        const double deadline_s = fast ? 0.8 : 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const DiffusionParameters truth{talent * kDrifts[k] + (fast ? 0 : better),
                                          fast ? boundary : boundary + more, fast ? ter_s : ter_s + later_s};
          for (int i = 0; i < 40; ++i) trials.push_back(one_trial(truth, k, deadline_s, cell, draws));
        }
        const auto fit =
            fit_diffusion(trials, 3, static_cast<std::uint64_t>(study), 2 * person + (fast ? 1 : 2));
        if (!fit.estimates) continue;
        const std::string who = std::to_string(person), condition = fast ? "speed" : "accuracy";
        std::vector<double> drift;
        for (const auto& draw : fit.estimates->draws) drift.push_back(mean(draw.drift));
        const double values[] = {fit.estimates->boundary.value, fit.estimates->nondecision_s.value,
                                 quantile(drift, 0.5)};
        for (std::size_t m = 0; m < 3; ++m) measures.push_back({who, condition, kMeasures[m], "", values[m]});
      }
    }
    ++shares.studies;
    const auto found = effects(measures, [](const auto&, const auto&) { return false; });
    for (std::size_t m = 0; m < 3; ++m) {
      const auto& interval = found.at(m).difference->interval;
      shares.held[m] += holds(interval, kEffects[m]);
      shares.claimed[m] += !holds(interval, 0);
    }
  }
  return shares;
}

}  // namespace

// TURNPOINT_GROUP_STUDIES=1000 prints the shares for 8 and for 20 people; TURNPOINT_GROUP_FIRST=50 begins at
// that study, and TURNPOINT_GROUP_PEOPLE=20 takes one size of group, so that a run can be made in parts.
TEST_CASE(
    "A group's effects on the diffusion's parameters hold the truth, and none is claimed that is not there",
    "[analysis][diffusion]") {
  const int studies = number_from("TURNPOINT_GROUP_STUDIES", 0),
            first = number_from("TURNPOINT_GROUP_FIRST", 0), only = number_from("TURNPOINT_GROUP_PEOPLE", 0);
  if (studies == 0) {
    const auto shares = group_shares(5, 5, 0);
    CHECK(shares.claimed[0] >= 4);
    CHECK(shares.claimed[1] + shares.claimed[2] <= 2);
    return;
  }
  for (const int people : {8, 20}) {
    if (only > 0 && people != only) continue;
    const auto shares = group_shares(people, studies, first);
    const auto percent = [&](int count) { return 100.0 * count / shares.studies; };
    std::cout << people << " people: covered, boundary " << percent(shares.held[0]) << " %, time outside "
              << percent(shares.held[1]) << " %, drift " << percent(shares.held[2])
              << " %; claimed, time outside " << percent(shares.claimed[1]) << " %, drift "
              << percent(shares.claimed[2]) << " %" << std::endl;
    for (std::size_t m = 0; m < 3; ++m) CHECK(percent(shares.held[m]) > 92);
    for (std::size_t m = 1; m < 3; ++m) CHECK(percent(shares.claimed[m]) < 7);
  }
}

TEST_CASE("One answer that came before all others does not hide the maximum of the likelihood",
          "[analysis][diffusion]") {
  // Without contaminants, the time outside the decision must be shorter than it. People of `speed_acc` have
  // such answers.
  rnd::Draws draws({10, rnd::Stream::observer, 0, 0, 0});
  auto trials = simulated(kAccuracy, 0, kCells[0], {100, 100, 100}, draws);
  for (const double first_s : {0.25, 0.15}) {
    trials.front().time_s = first_s;
    DiffusionOptions options;
    options.contaminants = false, options.start = true, options.method = DiffusionOptions::Method::likelihood;
    const auto fit = fit_diffusion(trials, 3, 1, 1, options).estimates;
    REQUIRE(fit);
    const auto log_likelihood = [&](double boundary, double ter_s, double start,
                                    const std::vector<double>& drift) {
      double sum = 0;
      for (const auto& trial : trials)
        sum += log_density({drift[trial.difficulty] / 0.1, boundary / 0.1, start}, trial.correct,
                           trial.time_s - ter_s);
      return sum;
    };
    std::vector<double> drift;
    for (const auto& one : fit->drift) drift.push_back(one.value);
    const double highest =
        log_likelihood(fit->boundary.value, fit->nondecision_s.value, fit->start.value, drift);
    CHECK(highest == Approx(fit->log_likelihood).margin(1e-6));
    int higher = 0;
    for (int i = 0; i < 20000; ++i) {  // near the maximum, and far from it
      const double far = i % 2 == 0 ? 0.02 : 0.5;
      std::vector<double> others;
      for (const double v : drift) others.push_back(v + 0.2 * far * draws.normal());
      higher +=
          log_likelihood(fit->boundary.value * std::exp(far * draws.normal()),
                         std::min(fit->nondecision_s.value * std::exp(far * draws.normal()), 0.999 * first_s),
                         std::clamp(fit->start.value + 0.3 * far * draws.normal(), 0.01, 0.99),
                         others) > highest + 1e-6;
    }
    CHECK(higher == 0);
    options.method = DiffusionOptions::Method::posterior;
    CHECK(fit_diffusion(trials, 3, 1, 1, options).estimates);
  }
}

TEST_CASE("An end of an interval hardly depends on which draws were taken", "[analysis][diffusion]") {
  // A condition whose posterior has two modes. Times in ms, below 0 of wrong answers. With the draws of the
  // best round alone, the lower end of the time outside the decision moved by 12 % of the width.
  const std::vector<std::vector<int>> times_ms{
      {661,  -566, 667,  548, -560, 736,  605, 667,  639,  531,  658,  -750, 577,  679,
       -830, -704, -543, 549, -803, -558, 612, -671, -568, -559, -646, 750,  -573, 701},
      {663, -528, 922,  704, -592, 544, -687, 759, 594, 798,  578, 666, 536, 834,
       594, -579, -662, 659, 743,  793, 529,  517, 688, -524, 525, 599, 569, -529},
      {546, 563, 591, 536, 608, 522, 595, 746, 594, 557, 579,  544, 640, 596,
       543, 535, 513, 602, 571, 696, 552, 546, 565, 536, -498, 543, 569, 544}};
  std::vector<DiffusionTrial> trials;
  for (std::size_t difficulty = 0; difficulty < times_ms.size(); ++difficulty)
    for (const int time_ms : times_ms[difficulty])
      trials.push_back({difficulty, DiffusionTrial::Outcome::answered, time_ms > 0,
                        std::abs(time_ms) / 1000.0, 1.0, 0.15});
  std::vector<double> low, high;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto fit = fit_diffusion(trials, 3, seed, 1);
    REQUIRE(fit.estimates);
    CHECK(fit.estimates->effective_draws >= 400);
    low.push_back(fit.estimates->nondecision_s.interval.low);
    high.push_back(fit.estimates->nondecision_s.interval.high);
  }
  const double width = mean(high) - mean(low);
  CHECK(std::sqrt(variance(low)) < 0.07 * width);
  CHECK(std::sqrt(variance(high)) < 0.07 * width);
}
