#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "station/core/draws.hpp"
#include "station/procedure/limits.hpp"
#include "station/procedure/psychometric.hpp"
#include "station/procedure/trace.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;
namespace rnd = turnpoint::core;

namespace {

Spec series_of(int series) {
  Spec spec;
  spec.name = "limits";
  spec.level = "level";
  spec.kind = Kind::limits;
  spec.tracks = "yes";
  spec.min = -10, spec.max = 10;
  spec.step = {2};
  spec.ascending.values = {-8};
  spec.descending.values = {8};
  spec.series = series;
  return spec;
}

Spec ascending(int series) {
  auto spec = series_of(series);
  spec.descending = {};
  return spec;
}

using Share = std::function<double(double)>;
Share normal_around(double mean, double sd) {
  return [=](double level) { return normal_cdf((level - mean) / sd); };
}

/// What is expected of one series: the probability that it has a midpoint, and the mean and variance of that
/// midpoint.
struct Expected {
  double used = 0, mean = 0, variance = 0, trials = 0;
};

/// Enumerates the Markov chain of one series: its state is the number of steps and of new answers in a row.
/// Written from the definition in the README, without the procedure's code.
Expected enumerate(const Share& share, double start, double step, double end, int n_change) {
  const auto levels =
      static_cast<std::size_t>(std::floor(std::fabs(end - start) / std::fabs(step) + 1e-9)) + 1;
  std::vector<double> run(static_cast<std::size_t>(n_change), 0.0);
  run[0] = 1;
  Expected all;
  double squares = 0;
  for (std::size_t k = 0; k < levels; ++k) {
    const double level = start + static_cast<double>(k) * step;
    const double changes = step > 0 ? share(level) : 1 - share(level);
    std::vector<double> next(run.size(), 0.0);
    for (std::size_t r = 0; r < run.size(); ++r) {
      all.trials += run[r];
      next[0] += run[r] * (1 - changes);
      if (r + 1 < run.size()) {
        next[r + 1] += run[r] * changes;
        continue;
      }
      // the answer had changed already in the first trial, so there is no midpoint
      if (k + 1 == run.size()) continue;
      const double midpoint = level - (static_cast<double>(n_change) - 0.5) * step;
      all.used += run[r] * changes;
      all.mean += run[r] * changes * midpoint, squares += run[r] * changes * midpoint * midpoint;
    }
    run = next;
  }
  all.mean /= all.used;
  all.variance = squares / all.used - all.mean * all.mean;
  return all;
}

/// Runs the procedure with an observer who answers 1 with this probability.
std::unique_ptr<Procedure> run(const Spec& spec, const Share& share, std::uint64_t seed) {
  auto procedure = make_procedure(spec, {}, key_of(seed, 0, 0, 0));
  rnd::Draws draws({seed, rnd::Stream::observer, 0, 0, 0});
  while (const auto proposal = procedure->next())
    procedure->record(draws.uniform() < share(proposal->level) ? Answer::one : Answer::zero);
  return procedure;
}

struct Moments {
  double n = 0, sum = 0, squares = 0;
  void add(double value) { ++n, sum += value, squares += value * value; }
  double mean() const { return sum / n; }
  double variance() const { return squares / n - mean() * mean(); }
  double error() const { return std::sqrt(variance() / n); }
};

}  // namespace

TEST_CASE("limits: two series worked out by hand", "[procedure][limits]") {
  auto spec = series_of(2);
  // ascending: -8 -6 -4 -2 no, 0 yes: midpoint -1. Descending: 8 6 4 yes, 2 no: midpoint 3.
  const bool up_first = trace(spec, {}, "").next == -8;
  const auto result = trace(spec, {}, up_first ? "000011110" : "111000001");
  CHECK(result.levels == (up_first ? std::vector<double>{-8, -6, -4, -2, 0, 8, 6, 4, 2}
                                   : std::vector<double>{8, 6, 4, 2, -8, -6, -4, -2, 0}));
  CHECK_FALSE(result.next.has_value());
  CHECK(result.estimates.at("threshold ascending").mean == -1);
  CHECK(result.estimates.at("threshold descending").mean == 3);
  CHECK(result.estimates.at("threshold").mean == 1);
  CHECK(result.estimates.at("threshold ascending - descending").mean == -4);
  CHECK_FALSE(result.estimates.at("threshold").sd.has_value());
  CHECK(result.estimates.at("threshold").basis == "midpoints of 2 series");
}

TEST_CASE("limits: the standard error is that of the midpoints over the series", "[procedure][limits]") {
  // midpoints -1, 1, 3 and -3: mean 0, variance 20 / 3, standard error sqrt(20 / 3 / 4)
  const auto result = trace(ascending(4), {},
                            "00001"
                            "000001"
                            "0000001"
                            "0001");
  REQUIRE(result.reversals == std::vector<double>{-1, 1, 3, -3});
  CHECK(result.estimates.size() == 1);
  const auto& threshold = result.estimates.at("threshold");
  CHECK(threshold.mean == 0);
  CHECK(*threshold.sd == Approx(std::sqrt(20.0 / 3 / 4)));
  CHECK(threshold.basis == "midpoints of 4 ascending series; SD is the standard error");
}

TEST_CASE("limits: with several new answers in a row, a single slip does not end a series",
          "[procedure][limits]") {
  auto spec = ascending(1);
  spec.n_change = 2;
  const auto result = trace(spec, {}, "0100011");
  CHECK(result.levels == std::vector<double>{-8, -6, -4, -2, 0, 2, 4});
  CHECK_FALSE(result.next.has_value());
  CHECK(result.reversals == std::vector<double>{1});
}

TEST_CASE("limits: series that change at once, or not before their end, are left out",
          "[procedure][limits]") {
  const auto result = trace(ascending(3), {},
                            "1"
                            "0000000000"
                            "00001");
  CHECK_FALSE(result.next.has_value());
  CHECK(result.levels[10] == 10);  // the last level of the second series
  CHECK(result.reversals == std::vector<double>{-1});
  CHECK(result.estimates.at("threshold").basis == "midpoints of 1 of 3 ascending series");
  CHECK(trace(ascending(2), {}, "11").estimates.empty());
}

TEST_CASE("limits: an unanswered trial is repeated; if nobody answers, the procedure ends",
          "[procedure][limits]") {
  const auto procedure = make_procedure(ascending(2), {}, {});
  procedure->record(Answer::zero);
  for (int i = 0; i < 3; ++i) {
    procedure->record(Answer::none);
    CHECK(procedure->next()->level == -6);
  }
  procedure->record(Answer::zero);
  CHECK(procedure->next()->level == -4);
  CHECK(procedure->recorded() == 2);
  int trials = 0;
  for (; procedure->next() && trials < 100; ++trials) procedure->record(Answer::none);
  CHECK(trials == 8);
  CHECK(procedure->estimates().empty());
}

TEST_CASE("limits: both directions and all starts come equally often, and depend on the seed",
          "[procedure][limits]") {
  const auto order = GENERATE(Directions::alternate, Directions::random);
  auto spec = series_of(12);
  spec.directions = order;
  spec.ascending.values = {-10, -8, -6}, spec.descending.values = {6, 10};
  std::map<std::vector<double>, int> orders;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto procedure = make_procedure(spec, {}, key_of(seed, 0, 0, 0));
    std::vector<double> starts;
    while (const auto proposal = procedure->next()) {
      starts.push_back(proposal->level);
      // the first answer of each series already is the one that ends the series
      procedure->record(proposal->level < 0 ? Answer::one : Answer::zero);
    }
    REQUIRE(starts.size() == 12);
    for (const double start : spec.ascending.values)
      CHECK(std::count(starts.begin(), starts.end(), start) == 2);
    for (const double start : spec.descending.values)
      CHECK(std::count(starts.begin(), starts.end(), start) == 3);
    if (order == Directions::alternate)
      for (std::size_t i = 1; i < starts.size(); ++i) CHECK(starts[i] * starts[i - 1] < 0);
    ++orders[starts];
  }
  CHECK(orders.size() > 15);
  spec.ascending = {{}, std::pair(-10.0, -6.0)};
  Moments starts;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const auto procedure = make_procedure(spec, {}, key_of(seed, 0, 0, 0));
    const double start = procedure->next()->level;
    if (start > 0) continue;
    CHECK((start >= -10 && start <= -6));
    starts.add(start);
  }
  CHECK(std::fabs(starts.mean() + 8) < 4 * starts.error());
  CHECK(starts.variance() == Approx(16.0 / 12).epsilon(0.3));
}

TEST_CASE("limits: mean, variance and number of trials are those of the enumerated Markov chain",
          "[procedure][limits]") {
  const int n_change = GENERATE(1, 2, 3);
  const double sd = GENERATE(1.0, 4.0);
  const auto share = normal_around(0.7, sd);
  auto spec = series_of(6);
  spec.n_change = n_change;
  const auto up = enumerate(share, -8, 2, 10, n_change), down = enumerate(share, 8, -2, -10, n_change);
  Moments ups, downs, thresholds, differences, trials, used;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const auto procedure = run(spec, share, seed);
    const auto estimates = procedure->estimates();
    trials.add(procedure->recorded());
    used.add(static_cast<double>(procedure->reversals().size()));
    if (const auto found = estimates.find("threshold ascending"); found != estimates.end())
      ups.add(found->second.mean);
    if (const auto found = estimates.find("threshold descending"); found != estimates.end())
      downs.add(found->second.mean);
    if (!estimates.count("threshold")) continue;
    thresholds.add(estimates.at("threshold").mean);
    differences.add(estimates.at("threshold ascending - descending").mean);
  }
  INFO("n_change " << n_change << ", sd " << sd << ": ascending " << up.mean << ", descending " << down.mean);
  CHECK(std::fabs(ups.mean() - up.mean) < 4 * ups.error());
  CHECK(std::fabs(downs.mean() - down.mean) < 4 * downs.error());
  CHECK(std::fabs(thresholds.mean() - 0.5 * (up.mean + down.mean)) < 4 * thresholds.error());
  CHECK(std::fabs(differences.mean() - (up.mean - down.mean)) < 4 * differences.error());
  CHECK(std::fabs(trials.mean() - 3 * (up.trials + down.trials)) < 4 * trials.error());
  CHECK(std::fabs(used.mean() - 3 * (up.used + down.used)) < 4 * used.error() + 0.01);
  // if every series has a midpoint, the number of midpoints is fixed
  if (up.used > 0.999 && down.used > 0.999)
    CHECK(thresholds.variance() == Approx(0.25 * (up.variance + down.variance) / 3).epsilon(0.1));
  // With a shallow psychometric function, the answers change too early in both directions.
  if (n_change == 1) CHECK(up.mean < down.mean);
}

TEST_CASE("limits: the standard error holds in repeated sessions", "[procedure][limits]") {
  const auto share = normal_around(0.7, 2.0);
  const auto spec = series_of(20);
  const auto up = enumerate(share, -8, 2, 10, 1), down = enumerate(share, 8, -2, -10, 1);
  Moments squared_errors;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const auto estimates = run(spec, share, seed)->estimates();
    squared_errors.add(std::pow(*estimates.at("threshold").sd, 2));
  }
  CHECK(squared_errors.mean() == Approx(0.25 * (up.variance + down.variance) / 10).epsilon(0.03));
}

TEST_CASE("limits: on a scale of ratios, steps and midpoints are geometric", "[procedure][limits]") {
  auto spec = ascending(2);
  spec.scale = Scale::dB;
  spec.min = 0.1, spec.max = 10;
  spec.ascending.values = {0.1};
  spec.step = {20};
  const auto result = trace(spec, {},
                            "001"
                            "01");
  CHECK(result.levels[1] == Approx(1));
  CHECK(result.levels[2] == 10);  // a rounding error does not end the series
  CHECK(result.reversals[0] == Approx(std::sqrt(10.0)));
  CHECK(result.reversals[1] == Approx(std::sqrt(0.1)));
  CHECK(result.estimates.at("threshold").mean == Approx(1));
  // The midpoints are +-10 dB: the standard error is 10 dB, or ln(10) / 2 in natural logarithms.
  CHECK(*result.estimates.at("threshold").sd == Approx(std::log(10.0) / 2));
  spec.step = {1e6};  // such a step is refused, but makes no level overflow or become 0
  CHECK(validate(spec).size() == 1);
}

TEST_CASE("limits: the levels that are listed are those that sessions present", "[procedure][limits]") {
  auto spec = series_of(12);
  spec.ascending.values = {-8, -9.5}, spec.descending.values = {8, 9};
  SECTION("on a straight scale") {}
  SECTION("on a scale of ratios, whose last step would pass the limit") {
    spec.scale = Scale::dB, spec.min = 0.1, spec.max = 9.5;
    spec.ascending.values = {0.1, 0.25}, spec.descending.values = {9, 8}, spec.step = {3};
  }
  std::set<double> presented;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const rnd::DrawKey key{seed, rnd::Stream::level_order, 0, 0, 0};
    auto procedure = make_procedure(spec, {}, key);
    rnd::Draws answers({seed, rnd::Stream::observer, 0, 0, 0});
    const double likely = answers.uniform();
    while (const auto proposal = procedure->next()) {
      presented.insert(proposal->level);
      procedure->record(answers.uniform() < likely ? Answer::one : Answer::zero);
    }
  }
  const auto listed = levels_of_series(spec, 60);
  REQUIRE(listed.size() == presented.size());
  std::size_t i = 0;
  for (const double level : presented) CHECK(listed[i++] == Approx(level).epsilon(1e-12).margin(1e-12));
  CHECK(levels_of_series(spec, listed.size() - 1).empty());
  auto impossible = spec;
  impossible.scale = Scale::log10, impossible.min = -10;
  CHECK(levels_of_series(impossible, 60).empty());
  spec.ascending.uniform = {-8, -6};
  CHECK(levels_of_series(spec, 60).empty());
}

TEST_CASE("limits: the state hash differs with every answer, and is that of the same answers",
          "[procedure][limits]") {
  const auto spec = series_of(4);
  const auto key = key_of(5, 0, 0, 0);
  const auto one = make_procedure(spec, {}, key), other = make_procedure(spec, {}, key);
  std::vector<std::uint64_t> seen{one->state_hash()};
  for (const char answer : std::string("0-00--1110-001"))
    if (one->next()) {
      const auto given = answer == '-' ? Answer::none : answer == '1' ? Answer::one : Answer::zero;
      one->record(given), other->record(given);
      CHECK(one->state_hash() == other->state_hash());
      CHECK(std::find(seen.begin(), seen.end(), one->state_hash()) == seen.end());
      seen.push_back(one->state_hash());
    }
}

TEST_CASE("limits that cannot run are refused with their key", "[procedure][limits]") {
  const auto key = [](auto&& change) {
    auto spec = series_of(4);
    change(spec);
    const auto faults = validate(spec);
    return faults.size() == 1 ? faults.front().key : std::to_string(faults.size()) + " faults";
  };
  CHECK(key([](Spec&) {}) == "0 faults");
  CHECK(key([](Spec& spec) { spec.tracks.clear(); }) == "tracks");
  CHECK(key([](Spec& spec) { spec.step = {}; }) == "step");
  CHECK(key([](Spec& spec) { spec.step = {0}; }) == "step");
  CHECK(key([](Spec& spec) { spec.step = {2, 1}; }) == "step");
  CHECK(key([](Spec& spec) { spec.min = 10; }) == "min");
  CHECK(key([](Spec& spec) { spec.max.reset(); }) == "min");
  CHECK(key([](Spec& spec) { spec.scale = Scale::dB; }) == "min");
  CHECK(key([](Spec& spec) { spec.series = 3; }) == "series");
  CHECK(key([](Spec& spec) { spec.series = 3, spec.descending = {}; }) == "0 faults");
  CHECK(key([](Spec& spec) { spec.series = 0; }) == "series");
  CHECK(key([](Spec& spec) { spec.n_change = 0; }) == "n_change");
  CHECK(key([](Spec& spec) { spec.ascending = spec.descending = {}; }) == "start_ascending");
  CHECK(key([](Spec& spec) { spec.ascending.values = {-12}; }) == "start_ascending");
  CHECK(key([](Spec& spec) { spec.descending.values = {4, 11}; }) == "start_descending");
  CHECK(key([](Spec& spec) { spec.ascending.values = {-8, 8}; }) == "start_ascending");
  CHECK(key([](Spec& spec) { spec.descending = {}, spec.ascending.values = {9}; }) == "start_ascending");
  CHECK(key([](Spec& spec) { spec.n_change = 10; }) == "2 faults");
  CHECK(key([](Spec& spec) { spec.descending = {{}, std::pair(-9.0, -7.0)}; }) == "2 faults");
}
