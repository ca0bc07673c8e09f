#include <algorithm>
#include <cmath>

#include "station/core/draws.hpp"
#include "station/procedure/trace.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

Spec approximation(double start, double step, double target) {
  Spec spec;
  spec.name = "asa";
  spec.level = "level";
  spec.kind = Kind::accelerated_stochastic_approximation;
  spec.start = start;
  spec.step = {step};
  spec.target = target;
  spec.stop.trials = 100'000;
  return spec;
}

/// The levels by the recursion of Kesten (1958), computed from the whole list of answers.
std::vector<double> reference(const std::vector<int>& answers, double start, double c, double phi,
                              double low = -1e9, double high = 1e9) {
  std::vector<double> x{start};
  for (std::size_t n = 1; n <= answers.size(); ++n) {
    int shifts = 0;
    for (std::size_t k = 1; k < n; ++k) shifts += answers[k] != answers[k - 1];
    const double gain = n < 3 ? c / static_cast<double>(n) : c / (2 + shifts);
    x.push_back(std::clamp(x.back() - gain * (answers[n - 1] - phi), low, high));
  }
  return x;
}

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

}  // namespace

TEST_CASE("accelerated stochastic approximation: a sequence worked out by hand", "[procedure]") {
  // The step constant c is 8, and the target proportion phi is .75: after a 1 the level falls by c / k * .25,
  // after a 0 it rises by c / k * .75.
  //   answers        1   1   0   0   1     0     0
  //   changes so far 0   0   1   1   2     3     3
  //   k              1   2   3   3   4     5     5
  //   level      10  8   7   9   11  10.5  11.7  12.9
  const auto result = trace(approximation(10, 8, 0.75), {}, "1100100");
  const double expected[] = {10, 8, 7, 9, 11, 10.5, 11.7};
  REQUIRE(result.levels.size() == 7);
  for (std::size_t i = 0; i < 7; ++i) CHECK(result.levels[i] == Approx(expected[i]).epsilon(1e-15));
  CHECK(*result.next == Approx(12.9).epsilon(1e-15));
  CHECK(result.reversals == std::vector<double>{7, 11, 10.5});
  const auto estimate = result.estimates.at("threshold");
  CHECK(estimate.mean == *result.next);
  CHECK(estimate.mode == *result.next);
  CHECK_FALSE(estimate.sd.has_value());
  CHECK(estimate.basis == "the level after 7 answers with 3 reversals");
  CHECK(trace(approximation(10, 8, 0.75), {}, "111").estimates.empty());
  // A change of answer at the second trial does not shorten the second step, c / 2 * .75, but the third, c /
  // 3 * .75.
  CHECK(trace(approximation(10, 8, 0.75), {}, "100").levels == std::vector<double>{10, 8, 11});
  CHECK(*trace(approximation(10, 8, 0.75), {}, "100").next == Approx(13).epsilon(1e-15));
}

TEST_CASE("accelerated stochastic approximation follows the recursion for any answers", "[procedure]") {
  const auto target = GENERATE(0.001, 0.25, 0.5, 0.75, 0.999);
  const auto limited = GENERATE(false, true);
  auto spec = approximation(5, 3, target);
  if (limited) spec.min = 2, spec.max = 6;
  turnpoint::core::Draws draws({17});
  const auto procedure = make_procedure(spec, {}, {});
  std::vector<int> answers;
  for (int n = 0; n < 300; ++n) {
    answers.push_back(draws.uniform() < 0.6);
    procedure->record(answers.back() ? Answer::one : Answer::zero);
    const auto expected = reference(answers, 5, 3, target, limited ? 2 : -1e9, limited ? 6 : 1e9);
    CHECK(procedure->next()->level == Approx(expected.back()).epsilon(1e-12));
  }
}

TEST_CASE("accelerated stochastic approximation converges on its target, near 0 and near 1 too",
          "[procedure]") {
  const auto target = GENERATE(0.05, 0.5, 0.794, 0.95);
  const double truth = std::log(target / (1 - target));
  double sum = 0, squares = 0;
  constexpr int kTracks = 200, kTrials = 600;
  for (int track = 0; track < kTracks; ++track) {
    turnpoint::core::Draws draws({static_cast<std::uint64_t>(track)});
    const auto procedure = make_procedure(approximation(truth + (track % 2 ? 3 : -3), 8, target), {}, {});
    for (int n = 0; n < kTrials; ++n)
      procedure->record(draws.uniform() < logistic(procedure->next()->level) ? Answer::one : Answer::zero);
    const double share = logistic(procedure->estimates().at("threshold").mean);
    sum += share, squares += share * share;
  }
  const double mean = sum / kTracks;
  const double error = std::sqrt((squares / kTracks - mean * mean) / kTracks);
  INFO(target << ": settles at " << mean << " +- " << error);
  CHECK(std::fabs(mean - target) < 0.015);
  CHECK(error < 0.005);
}

TEST_CASE("accelerated stochastic approximation ends by trials, or by reversals at a smallest step",
          "[procedure]") {
  auto spec = approximation(10, 8, 0.5);
  spec.stop = {};
  spec.stop.reversals = 6;
  const auto result = trace(spec, {}, "1010101");
  CHECK_FALSE(result.next.has_value());
  CHECK(result.estimates.at("threshold").mean == Approx(result.levels.back() - 8.0 / (2 + 6) * 0.5));
  spec.stop = {};
  spec.stop.trials = 3;
  CHECK(trace(spec, {}, "11").next.has_value());
  CHECK_FALSE(trace(spec, {}, "111").next.has_value());
}

TEST_CASE("accelerated stochastic approximation multiplies levels on a logarithmic scale", "[procedure]") {
  auto spec = approximation(100, 20, 0.5);
  spec.scale = Scale::dB;
  CHECK(*trace(spec, {}, "1").next == Approx(100 * std::pow(10.0, -10.0 / 20)));
}

TEST_CASE("an unanswered trial of an accelerated stochastic approximation is repeated at the same level",
          "[procedure]") {
  const auto procedure = make_procedure(approximation(10, 8, 0.75), {}, {});
  procedure->record(Answer::one);
  procedure->record(Answer::none);
  CHECK(procedure->next()->level == 8);
  procedure->record(Answer::one);
  // this is the second answer, so its step is c / 2 (c: the step constant)
  CHECK(procedure->next()->level == 7);
}

TEST_CASE("an accelerated stochastic approximation that cannot run is refused with its key", "[procedure]") {
  const auto key = [](auto&& change) {
    auto spec = approximation(10, 8, 0.75);
    spec.min = 0, spec.max = 20;
    change(spec);
    const auto faults = validate(spec);
    return faults.size() == 1 ? faults.front().key : std::to_string(faults.size()) + " faults";
  };
  CHECK(key([](Spec&) {}) == "0 faults");
  CHECK(key([](Spec& spec) { spec.step = {}; }) == "step");
  CHECK(key([](Spec& spec) { spec.step = {0}; }) == "step");
  CHECK(key([](Spec& spec) { spec.step = {2, 1}; }) == "step");
  CHECK(key([](Spec& spec) { spec.target.reset(); }) == "target");
  CHECK(key([](Spec& spec) { spec.target = 1; }) == "target");
  CHECK(key([](Spec& spec) { spec.start.reset(); }) == "start");
  CHECK(key([](Spec& spec) { spec.start = 30; }) == "start");
  CHECK(key([](Spec& spec) {
          spec.max = 0;
          spec.start = 0;
        }) == "min");
  CHECK(key([](Spec& spec) { spec.stop = {}; }) == "stop");
}
