#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "station/procedure/posterior.hpp"
#include "station/procedure/psychometric.hpp"
#include "station/procedure/trace.hpp"
#include "tests/procedure/watson.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

/// Watson (2017), Example 4: contrast sensitivity over contrast (dB) and spatial frequency.
Spec contrast_sensitivity() {
  Spec spec = watson_1();
  spec.second.emplace();
  spec.second->level = "frequency";
  spec.stimuli.values = range(-50, 0, 2);
  spec.second->stimuli.values = range(0, 40, 2);
  spec.threshold.values = range(-60, -40, 2);
  spec.gradient.values = range(0.8, 1.6, 0.2);
  spec.floor.values = range(-50, -30, 2);
  spec.slope.values = {3};
  spec.lapse.values = {0.01};
  spec.stop.trials = 1000;
  return spec;
}

Spec criterion() {
  Spec spec;
  spec.name = "criterion", spec.level = "step", spec.kind = Kind::quest_plus, spec.tracks = "yes";
  spec.signal_detection = true, spec.scale = Scale::log10;
  spec.stimuli.values = {0, 0.01, 0.015, 0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.2, 0.3};
  spec.threshold.values = {0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.2};
  spec.slope.values = {0.5, 1, 1.5, 2, 3};
  spec.criterion.values = {-0.5, 0, 0.5, 1, 1.5, 2};
  spec.lapse.values = {0.005, 0.02};
  spec.stop.trials = 1000;
  return spec;
}

Spec criterion_surface() {
  Spec spec = criterion();
  spec.kind = Kind::psi_marginal, spec.scale = Scale::dB, spec.nuisance = {"lapse", "slope"};
  spec.stimuli.values = {0, 0.02, 0.045, 0.1, 0.2, 0.4};
  spec.second = Second{"place_mm", {{120, 135, 150, 165, 180}, ""}, 150};
  spec.threshold.values = {0.03, 0.05, 0.08, 0.12, 0.2};
  spec.gradient.values = {-0.2, -0.1, 0, 0.1, 0.2};
  spec.floor.values = {0.04, 0.06};
  spec.slope.values = {1, 2};
  spec.criterion.values = {0, 0.7, 1.4};
  spec.lapse.values = {0.005, 0.03};
  spec.prior_threshold.normal = {0.1, 0.05}, spec.prior_criterion.normal = {0.7, 1.0};
  return spec;
}

Spec shifting_mean() {
  Spec spec = watson_1();
  spec.function = Function::normal;
  spec.second = Second{"second", {{-20, -10, 0, 10, 20}, ""}, 0};
  spec.stimuli.values = range(-20, 20, 2);
  spec.threshold.values = range(-8, 8, 4);
  spec.gradient.values = {-0.4, -0.2, 0, 0.2, 0.4};
  spec.slope.values = {2, 4, 8};
  spec.guess.values = {0.02};
  spec.lapse.values = {0.02, 0.05};
  spec.stop.trials = 1000;
  return spec;
}

/// How much of a run of two_dimensions.csv (make_two_dimensions.py) agrees.
struct Agreement {
  /// trials of the run; trials with the same choice; trials in which the other choice is exactly as
  /// informative
  int trials = 0, agree = 0, ties = 0;
  int parameters = 0;
  double worst = 0;  ///< largest error of a mean or a standard deviation, relative to the standard deviation
};

std::size_t nearest(const Posterior& posterior, double level, double second) {
  const auto& stimuli = posterior.stimuli();
  std::size_t found = 0;
  while (std::fabs(stimuli.at(found).level - level) > 1e-9 ||
         std::fabs(stimuli[found].second - second) > 1e-9)
    ++found;
  return found;
}

/// Gives the posterior the stimuli and answers of the run, and compares what it would have chosen. At both
/// ends of a symmetric grid, and where the floor decides, stimuli are equally informative; rounding then
/// decides.
Agreement compared(const std::string& run, const Spec& spec) {
  std::ifstream table(std::string(ZEST_TABLES) + "/two_dimensions.csv");
  REQUIRE(table);
  Posterior posterior(spec);
  Agreement found;
  for (std::string line; std::getline(table, line);) {
    std::vector<std::string> words;
    std::istringstream parts(line);
    for (std::string word; std::getline(parts, word, ',');) words.push_back(word);
    if (words.empty() || words[0] != run) continue;
    const double first = std::stod(words[words.size() - 3 + (words[1] == "end")]),
                 second = std::stod(words[words.size() - 2 + (words[1] == "end")]);
    if (words[1] == "end") {
      std::size_t k = 0;
      while (words[2] != kParameters.at(k).name) ++k;
      const auto own = posterior.estimate(static_cast<Posterior::Parameter>(k));
      found.worst =
          std::max({found.worst, std::fabs(own.mean - first) / second, std::fabs(*own.sd - second) / second});
      ++found.parameters;
      continue;
    }
    const auto information = posterior.information();
    const auto chosen = posterior.best_stimulus(), theirs = nearest(posterior, first, second);
    ++found.trials;
    found.agree += chosen == theirs;
    found.ties += chosen != theirs && information[theirs] > information[chosen] - 1e-12;
    posterior.update(theirs, words[4] == "1");
  }
  return found;
}

const std::map<std::string, std::function<Spec()>> kRuns{{"contrast-sensitivity", contrast_sensitivity},
                                                         {"criterion", criterion},
                                                         {"criterion-surface", criterion_surface},
                                                         {"shifting-mean", shifting_mean}};

}  // namespace

TEST_CASE("Watson's fourth example, contrast over spatial frequency, is reproduced trial by trial",
          "[procedure]") {
  const auto result = trace(contrast_sensitivity(), {}, "10111101111101111100111111100111");
  const std::vector<double> contrasts{0,   -4,  0,   0,   -38, 0,   -40, 0,   -26, -26, 0,
                                      -36, -36, 0,   -26, -26, -2,  -26, -6,  -26, 0,   -26,
                                      0,   -26, -32, -32, -34, -34, 0,   -26, 0,   -26};
  const std::vector<double> frequencies{40, 40, 34, 36, 0,  38, 0,  38, 18, 18, 40, 0, 0,  40, 20, 20,
                                        40, 22, 40, 20, 40, 18, 40, 18, 0,  0,  0,  0, 40, 18, 38, 18};
  CHECK(result.levels == contrasts);
  CHECK(result.second == frequencies);
  CHECK(result.estimates.at("floor").mode == -32);
  CHECK(result.estimates.at("threshold").mode == -56);
  CHECK(result.estimates.at("gradient").mode == Approx(1.4));
}

TEST_CASE("over 300 trials, stimuli and estimates are those of independent implementations", "[procedure]") {
  for (const auto& [run, spec] : kRuns) {
    INFO(run);
    const auto found = compared(run, spec());
    CHECK(found.trials == 300);
    CHECK(found.agree + found.ties == 300);
    CHECK(found.ties <= 30);
    CHECK(found.parameters >= 3);
    CHECK(found.worst < 1e-8);
  }
}

TEST_CASE("negative control: with another origin, floor, criterion or nuisance, stimuli differ",
          "[procedure]") {
  auto origin = criterion_surface();
  origin.second->origin = 151;
  CHECK(compared("criterion-surface", origin).agree < 250);
  auto kept = criterion_surface();
  kept.nuisance = {"lapse"};
  CHECK(compared("criterion-surface", kept).agree < 250);
  auto without_floor = contrast_sensitivity();
  without_floor.floor = {};
  CHECK(compared("contrast-sensitivity", without_floor).agree < 250);
  auto moved = criterion();
  for (auto& value : moved.criterion.values) value += 0.05;
  CHECK(compared("criterion", moved).agree < 250);
}

TEST_CASE("the information of a stimulus is the entropy that its answer removes, with all parameters",
          "[procedure]") {
  auto spec = criterion_surface();
  spec.nuisance = {};
  Posterior posterior(spec);
  CHECK(posterior.size() == 5 * 5 * 2 * 2 * 3 * 2);
  for (const int answer : {1, 0, 1, 1, 0}) {
    const auto information = posterior.information();
    REQUIRE(information.size() == 30);
    for (std::size_t i = 0; i < information.size(); ++i) {
      auto one = posterior, zero = posterior;
      one.update(i, true), zero.update(i, false);
      const double p = posterior.predictive(i);
      const double expected = p * one.entropy_nats() + (1 - p) * zero.entropy_nats();
      CHECK(information[i] == Approx(posterior.entropy_nats() - expected).margin(1e-12));
    }
    posterior.update(posterior.best_stimulus(), answer == 1);
  }
}

TEST_CASE("the rate of yes follows d' and the criterion, and false alarms only the criterion",
          "[procedure]") {
  const auto phi = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  for (const double c : {-1.0, 0.0, 0.7, 2.0}) {
    CHECK(detection_rate(Scale::log10, 0.1, 2, c, 0) == Approx(phi(-c)).epsilon(1e-12));
    CHECK(detection_rate(Scale::log10, 0.1, 2, c, 0.1) == Approx(phi(1 - c)).epsilon(1e-12));
    CHECK(detection_rate(Scale::dB, 0.1, 2, c, 0.2) == Approx(phi(4 - c)).epsilon(1e-12));
    CHECK(detection_rate(Scale::linear, -20, 2, c, -14) == Approx(phi(std::pow(10, 0.6) - c)).epsilon(1e-12));
    for (const double level : {-1.0, 1e-9, 1e9})
      CHECK((detection_rate(Scale::log10, 1e-9, 50, c, level) >= 0 &&
             detection_rate(Scale::log10, 1e9, 50, c, level) <= 1));
  }
  for (const double p : {1e-6, 0.1, 0.5, 0.975}) CHECK(phi(normal_quantile(p)) == Approx(p).epsilon(1e-9));
}

TEST_CASE("the threshold changes along the second dimension by its gradient, and ends at the floor",
          "[procedure]") {
  CHECK(threshold_at(Scale::linear, -20, 0.5, {}, 10) == -15);
  CHECK(threshold_at(Scale::linear, -20, 0.5, -12, 10) == -12);
  CHECK(threshold_at(Scale::log10, 0.1, 0.5, {}, 2) == Approx(1));
  CHECK(threshold_at(Scale::dB, 0.1, 2, {}, 10) == Approx(1));
  CHECK(threshold_at(Scale::dB, 0.1, -2, 0.05, 10) == 0.05);
  CHECK(std::isfinite(threshold_at(Scale::log10, 1e6, 1e6, {}, 1e6)));
  Posterior posterior(criterion_surface());
  const auto thresholds = posterior.thresholds();
  REQUIRE(thresholds.size() == 5);
  // at the origin it is the parameter itself, except where the floor is higher
  CHECK(thresholds[2].second == 150);
  auto spec = criterion_surface();
  spec.floor.values = {0.001, 0.002};
  const auto at_origin = Posterior(spec).thresholds()[2].estimate;
  const auto own = Posterior(spec).estimate(Posterior::threshold);
  CHECK(at_origin.mean == Approx(own.mean).epsilon(1e-12));
  CHECK(*at_origin.sd == Approx(*own.sd).epsilon(1e-12));
  CHECK(at_origin.interval->first == Approx(own.interval->first).epsilon(1e-9));
  CHECK(at_origin.interval->second == Approx(own.interval->second).epsilon(1e-9));
}

TEST_CASE(
    "without answers an interval is that of the prior, and a parameter that is known has none to speak of",
    "[procedure]") {
  auto spec = watson_1();
  // 40 points of equal weight, each spread over a cell of width 1: from 0.5 to 40.5
  spec.threshold.values = range(1, 40, 1);
  const auto interval = *Posterior(spec).estimate(Posterior::threshold).interval;
  CHECK(interval.first == Approx(1.5));
  CHECK(interval.second == Approx(39.5));
  // a rate cannot be below 0: cells from 0 to 0.005, 0.02 and 0.04
  spec.lapse.values = {0, 0.01, 0.03};
  const auto lapse = *Posterior(spec).estimate(Posterior::lapse).interval;
  CHECK(lapse.first == Approx(0.025 * 3 * 0.005));
  CHECK(lapse.second == Approx(0.04 - 0.025 * 3 * 0.02));
  CHECK(Posterior(spec).estimate(Posterior::slope).interval->first == 3.5);
  CHECK(Posterior(spec).estimate(Posterior::slope).interval->second == 3.5);
}

TEST_CASE("95 % of the intervals contain the true values of all parameters, if these come from the prior",
          "[procedure]") {
  using turnpoint::core::Draws;
  using turnpoint::core::Stream;
  auto spec = criterion();
  spec.second = Second{"place_mm", {{-30, 0, 30}, ""}, 0};
  spec.scale = Scale::dB;
  spec.threshold.values = range(0.02, 0.2, 0.015), spec.gradient.values = range(-0.2, 0.2, 0.04);
  spec.criterion.values = range(-0.5, 2, 0.25), spec.slope.values = {1.5}, spec.lapse.values = {0.01};
  constexpr int runs = 400, trials = 40;
  std::map<std::string, int> inside;
  for (int run = 0; run < runs; ++run) {
    Draws draws({static_cast<std::uint64_t>(run), Stream::observer, 0, 0, 0});
    const double t = draws.uniform(0.02, 0.2), g = draws.uniform(-0.2, 0.2), c = draws.uniform(-0.5, 2);
    const auto procedure = make_procedure(spec, {}, {});
    for (int trial = 0; trial < trials; ++trial) {
      const auto next = *procedure->next();
      const double at = threshold_at(Scale::dB, t, g, {}, *next.second);
      const double p = 0.01 + 0.98 * detection_rate(Scale::dB, at, 1.5, c, next.level);
      procedure->record(draws.uniform() < p ? Answer::one : Answer::zero);
    }
    const auto estimates = procedure->estimates();
    for (const auto& [name, value] :
         {std::pair("threshold", t), std::pair("gradient", g), std::pair("criterion", c)}) {
      const auto& interval = *estimates.at(name).interval;
      inside[name] += interval.first <= value && value <= interval.second;
    }
  }
  for (const auto& [name, count] : inside) {
    INFO(name << ": " << count << " of " << runs);
    CHECK(count >= 0.92 * runs);  // 95 % less three standard errors
    CHECK(count <= 0.98 * runs);
  }
}

TEST_CASE("a specification of two dimensions or a criterion that cannot work is refused at its key",
          "[procedure]") {
  const auto key = [](Spec spec) {
    const auto problems = validate(spec);
    return problems.empty() ? std::string("none") : problems.front().key;
  };
  CHECK(key(contrast_sensitivity()) == "none");
  CHECK(key(criterion()) == "none");
  auto spec = contrast_sensitivity();
  spec.gradient = {};
  CHECK(key(spec) == "grid.gradient");
  spec = contrast_sensitivity();
  spec.second.reset();
  CHECK(key(spec) == "grid.gradient");
  spec = contrast_sensitivity();
  spec.second->level = spec.level;
  CHECK(key(spec) == "second.level");
  spec = contrast_sensitivity();
  spec.scale = Scale::log10;
  CHECK(key(spec) == "grid.floor");
  spec = contrast_sensitivity();
  spec.lapse.values = range(0, 0.1, 0.001);
  CHECK(key(spec) == "none");
  spec.slope.values = range(1, 3, 0.5);
  CHECK(key(spec) == "grid.threshold");  // 546 stimuli x 305 525 points
  spec = contrast_sensitivity();
  spec.threshold.values = range(-60, -40, 0.1), spec.gradient.values = range(0.8, 1.6, 0.01);
  CHECK(key(spec) == "grid.threshold");  // 546 stimuli x 16 281 x 11 pairs
  spec = criterion();
  spec.tracks = "";
  CHECK(key(spec) == "tracks");
  spec = criterion();
  spec.guess.values = {0.5};
  CHECK(key(spec) == "grid.guess");
  spec = criterion();
  spec.criterion = {};
  CHECK(key(spec) == "grid.criterion");
  spec = criterion();
  spec.signal_detection = false, spec.guess.values = {0.02};
  CHECK(key(spec) == "grid.criterion");
  spec = criterion();
  spec.lapse.values = {0.5};
  CHECK(key(spec) == "grid.lapse");
}
