#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "station/analysis/mixed_fit.hpp"
#include "station/analysis/quantile.hpp"
#include "station/core/draws.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/number_from.hpp"

using namespace turnpoint;
using namespace turnpoint::analysis;

namespace {

using Words = std::vector<std::string>;

/// Returns the rows of a table beside this file, without comments and header.
std::vector<Words> table(const std::string& name) {
  std::ifstream file(std::string(MIXED_TABLES) + "/" + name);
  REQUIRE(file);
  std::vector<Words> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    Words words;
    std::istringstream parts(line);
    for (std::string word; std::getline(parts, word, ',');) words.push_back(word);
    rows.push_back(words);
  }
  rows.erase(rows.begin());
  return rows;
}

std::vector<PersonCounts> data_of(const std::string& set, double guess) {
  std::vector<PersonCounts> people;
  for (const auto& row : table("mixed_data.csv")) {
    if (row[0] != set) continue;
    if (people.empty() || people.back().person != row[1]) people.push_back({row[1], {}, guess});
    people.back().counts.push_back({std::stod(row[2]), std::stoi(row[3]), std::stoi(row[4])});
  }
  return people;
}

MixedFit fitted(const std::vector<PersonCounts>& people, Function function, double lapse = 0) {
  MixedOptions options;
  options.function = function, options.lapse_low = options.lapse_high = lapse;
  const auto result = fit_mixed(people, options);
  REQUIRE(result.fit);
  return *result.fit;
}

/// A simulated group of participants whose thresholds and slopes differ. answers() draws one set of answers.
struct Group {
  int people = 10, trials = 10;
  double threshold = 2, threshold_sd = 3, rate = 0.25, rate_sd = 0.04;

  std::vector<PersonCounts> answers(core::Draws& draws, std::vector<double>& thresholds) const {
    std::vector<PersonCounts> all;
    const auto normal = [&draws] {
      double sum = -6;
      for (int i = 0; i < 12; ++i) sum += draws.uniform();
      return sum;
    };
    for (int i = 0; i < people; ++i) {
      const double own_rate = rate + rate_sd * normal();
      const double intercept = -rate * threshold + rate * threshold_sd * normal();
      thresholds.push_back(-intercept / own_rate);
      PersonCounts person{"P" + std::to_string(i), {}, 0};
      for (const double level : {-10.0, -5.0, -2.0, 2.0, 5.0, 10.0, 14.0}) {
        LevelCount count{level, trials, 0};
        for (int k = 0; k < trials; ++k)
          count.positive += draws.uniform() < sigmoid(Function::normal, intercept + own_rate * level);
        person.counts.push_back(count);
      }
      all.push_back(person);
    }
    return all;
  }
};

bool contains(const Estimate& estimate, double value) {
  return estimate.interval.low <= value && value <= estimate.interval.high;
}

}  // namespace

TEST_CASE("A hierarchical fit agrees with lme4 on the same data", "[mixed]") {
  const auto recorded = table("mixed_lme4.csv");
  const std::map<std::string, std::pair<Function, double>> sets{{"sides", {Function::normal, 0}},
                                                                {"few", {Function::logistic, 0}},
                                                                {"contrast", {Function::weibull, 0.5}}};
  for (const auto& [set, how] : sets) {
    INFO(set);
    const auto fit = fitted(data_of(set, how.second), how.first);
    std::map<std::string, double> found{
        {"intercept", fit.intercept},       {"rate", fit.rate},
        {"intercept_se", fit.intercept_se}, {"rate_se", fit.rate_se},
        {"intercept_sd", fit.intercept_sd}, {"rate_sd", fit.rate_sd},
        {"correlation", fit.correlation},   {"log_likelihood", fit.log_likelihood}};
    for (const auto& person : fit.persons)
      if (person.threshold) found["threshold_" + person.person] = person.threshold->value;
    int compared = 0;
    for (const auto& row : recorded) {
      if (row[0] != set) continue;
      INFO(row[1]);
      const double expected = std::stod(row[2]);
      REQUIRE(found.count(row[1]) == 1);
      const bool error = row[1].ends_with("_se");
      CHECK(found[row[1]] == Approx(expected).epsilon(error ? 5e-3 : 5e-4).margin(1e-4));
      ++compared;
    }
    CHECK(compared == static_cast<int>(found.size()));
  }
}

TEST_CASE("Levels on a log10 scale and in another unit give the same group", "[mixed]") {
  auto people = data_of("contrast", 0.5);
  const auto in_dB = fitted(people, Function::weibull);
  for (auto& person : people)
    for (auto& point : person.counts) point.level = std::pow(10, point.level / 20);
  MixedOptions options;
  options.function = Function::weibull, options.scale = Scale::log10, options.lapse_high = 0;
  const auto as_ratio = fit_mixed(people, options);
  REQUIRE(as_ratio.fit);
  CHECK(20 * std::log10(as_ratio.fit->threshold->value) == Approx(in_dB.threshold->value).margin(1e-5));
  CHECK(as_ratio.fit->slope->value == Approx(in_dB.slope->value).epsilon(1e-5));
}

TEST_CASE("Few trials of an unusual participant are drawn to the group, many are not", "[mixed]") {
  core::Draws draws({23, core::Stream::observer, 0, 0, 0});
  std::vector<double> thresholds;
  const Group group{14, 20, 2, 2, 0.25, 0.03};
  auto people = group.answers(draws, thresholds);
  const auto unusual = [](int trials) {
    PersonCounts person{"unusual", {}, 0};
    for (const double level : {-10.0, -5.0, -2.0, 2.0, 5.0, 10.0, 14.0})
      person.counts.push_back(
          {level, trials,
           static_cast<int>(std::lround(trials * sigmoid(Function::normal, 0.25 * (level - 8))))});
    return person;
  };
  auto few = people, many = people;
  few.push_back(unusual(4)), many.push_back(unusual(400));
  const auto drawn = fitted(few, Function::normal).persons.back();
  const auto kept = fitted(many, Function::normal).persons.back();
  CHECK(kept.threshold->value == Approx(8).margin(0.15));
  CHECK(drawn.threshold->value < kept.threshold->value - 0.3);
  CHECK(drawn.threshold->value > 2);
  CHECK(drawn.shrinkage > 0.2);
  CHECK(kept.shrinkage < 0.1);
}

TEST_CASE("Partial pooling predicts participants better than their own fits, and its intervals hold",
          "[mixed]") {
  const int studies = number_from("TURNPOINT_STUDIES", 60);
  int group_holds = 0, person_holds = 0, people = 0;
  double pooled_error = 0, own_error = 0;
  // TURNPOINT_PEOPLE and TURNPOINT_LEVEL_TRIALS make other studies than ten people with ten trials a level
  const Group group{number_from("TURNPOINT_PEOPLE", 10), number_from("TURNPOINT_LEVEL_TRIALS", 10)};
  for (int study = 0; study < studies; ++study) {
    core::Draws draws({7, core::Stream::observer, 0, 0, study});
    std::vector<double> thresholds;
    const auto answers = group.answers(draws, thresholds);
    const auto fit = fitted(answers, Function::normal);
    REQUIRE(fit.threshold);
    group_holds += contains(*fit.threshold, group.threshold);
    for (std::size_t i = 0; i < thresholds.size(); ++i) {
      FitOptions alone;
      alone.function = Function::normal, alone.guess_value = 0, alone.lapse_high = 0;
      const auto own = fit_psychometric(answers[i].counts, alone);
      if (!own.parameters || !fit.persons[i].threshold) continue;
      ++people;
      person_holds += contains(*fit.persons[i].threshold, thresholds[i]);
      pooled_error += std::pow(fit.persons[i].threshold->value - thresholds[i], 2);
      own_error += std::pow(own.parameters->threshold - thresholds[i], 2);
    }
  }
  const double group_share = static_cast<double>(group_holds) / studies;
  const double person_share = static_cast<double>(person_holds) / people;
  INFO("group " << group_share << ", participants " << person_share << ", squared error "
                << pooled_error / people << " against " << own_error / people);
  // three standard errors of a proportion of 0.95 among n cases
  const auto reach = [](double n) { return 3 * std::sqrt(0.95 * 0.05 / n); };
  CHECK(std::fabs(group_share - 0.95) < reach(studies) + 0.01);
  CHECK(std::fabs(person_share - 0.95) < reach(people) + 0.02);
  CHECK(pooled_error < 0.95 * own_error);
  if (std::getenv("TURNPOINT_STUDIES")) FAIL("figures");
}

TEST_CASE("The shared lapse rate is found", "[mixed]") {
  core::Draws draws({9, core::Stream::observer, 0, 0, 0});
  std::vector<double> thresholds;
  auto people = Group{20, 60, 2, 2, 0.3, 0.03}.answers(draws, thresholds);
  for (auto& person : people)
    for (auto& point : person.counts) {
      // one trial in 12 is answered by guessing, which adds a slip rate of 1/24 for either answer
      int positive = 0;
      for (int i = 0; i < point.trials; ++i)
        positive += draws.uniform() < 1.0 / 12 ? draws.uniform() < 0.5 : i < point.positive;
      point.positive = positive;
    }
  MixedOptions options;
  options.tied_to_lapse = true;
  const auto result = fit_mixed(people, options);
  REQUIRE(result.fit);
  CHECK(result.fit->lapse == Approx(1.0 / 24).margin(0.012));
  options.lapse_high = 0;
  CHECK(fit_mixed(people, options).fit->log_likelihood < result.fit->log_likelihood - 5);
}

TEST_CASE("A reason replaces a hierarchical fit that is not possible", "[mixed]") {
  const auto people = data_of("sides", 0);
  const auto reason = [](std::vector<PersonCounts> part) {
    const auto result = fit_mixed(part, {});
    REQUIRE_FALSE(result.fit);
    REQUIRE_FALSE(result.statements.empty());
    return result.statements.front().code;
  };
  CHECK(reason({people.begin(), people.begin() + 2}) == "few-participants");
  auto reversed = people;
  for (auto& person : reversed)
    for (auto& point : person.counts) point.positive = point.trials - point.positive;
  CHECK(reason(reversed) == "reversed");
}
