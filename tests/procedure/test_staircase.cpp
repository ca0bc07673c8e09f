#include "station/procedure/trace.hpp"
#include "station/terms/usage_error.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

Spec two_down_one_up() {
  Spec spec;
  spec.name = "stairs";
  spec.level = "level";
  spec.kind = Kind::up_down;
  spec.start = 20;
  spec.step = {4, 2, 1};
  spec.n_down = 2;
  spec.initial_down = 1;
  spec.stop.trials = 100;
  return spec;
}

}  // namespace

TEST_CASE("2-down-1-up with an initial 1-down rule steps and reverses as Levitt describes", "[procedure]") {
  const auto result = trace(two_down_one_up(), {}, "11101110011");
  CHECK(result.levels == std::vector<double>{20, 16, 12, 8, 10, 10, 9, 9, 10, 11, 11});
  CHECK(result.reversals == std::vector<double>{8, 10, 9, 11});
}

TEST_CASE("a staircase averages the reversals that the protocol chose, and says which", "[procedure]") {
  auto spec = two_down_one_up();  // the answers below give reversals at 8, 10, 9, 11
  const auto estimate = [&spec](int discard) {
    spec.discard_reversals = discard;
    return trace(spec, {}, "11101110011").estimates;
  };
  CHECK(estimate(0).at("threshold").mean == 9.5);
  CHECK(estimate(0).at("threshold").basis == "reversals 1 to 4 of 4");
  CHECK(estimate(2).at("threshold").mean == 10);
  CHECK(estimate(2).at("threshold").basis == "reversals 3 to 4 of 4");
  // Three reversals remain, an odd number, so the first of them is dropped.
  CHECK(estimate(1).at("threshold").mean == 10);
  CHECK(estimate(1).at("threshold").basis == "reversals 3 to 4 of 4");
  CHECK(estimate(3).empty());
  spec.stop.reversals = 4;
  CHECK(validate(spec).size() == 1);
  CHECK(validate(spec).front().key == "discard_reversals");
  spec.discard_reversals = 2;
  CHECK(validate(spec).empty());
}

TEST_CASE("a weighted staircase balances at its target", "[procedure]") {
  Spec spec;
  spec.name = "q75";
  spec.level = "offset_mm";
  spec.kind = Kind::weighted_up_down;
  spec.start = 20;
  spec.min = -25;
  spec.max = 25;
  spec.step_down = {4, 2, 1};
  spec.target = 0.75;
  spec.stop.trials = 40;
  // The step up is three times the step down, so one wrong answer cancels three right ones.
  CHECK(trace(spec, {}, "1110").levels == std::vector<double>{20, 16, 12, 8});
  CHECK(*trace(spec, {}, "1110").next == Approx(14));
}

TEST_CASE("a staircase stays inside its limits and stops by its rules", "[procedure]") {
  auto spec = two_down_one_up();
  spec.initial_down.reset();
  spec.n_down = 1;
  spec.min = 10;
  spec.stop = {};
  spec.stop.reversals = 2;
  const auto result = trace(spec, {}, "1111101");
  CHECK(result.levels.back() == 12);
  CHECK_FALSE(result.next.has_value());
  CHECK_THROWS_AS(trace(spec, {}, "11111011"), turnpoint::terms::UsageError);
}

TEST_CASE("on a logarithmic scale steps multiply and the mean of reversals is a mean of logs",
          "[procedure]") {
  auto spec = two_down_one_up();
  spec.scale = Scale::log10;
  spec.start = 100;
  spec.n_down = 1;
  spec.initial_down.reset();
  spec.step = {1};
  const auto result = trace(spec, {}, "110100");
  CHECK(result.levels[1] == Approx(10));
  CHECK(result.levels[2] == Approx(1));
  CHECK(result.estimates.at("threshold").mean == Approx(std::sqrt(10.0)).epsilon(1e-12));
}

TEST_CASE("a staircase that cannot run is refused with the key and what is allowed", "[procedure]") {
  auto spec = two_down_one_up();
  spec.stop = {};
  CHECK_THROWS_AS(make_procedure(spec, {}, {}), std::invalid_argument);
  spec = two_down_one_up();
  spec.step = {0};
  CHECK_FALSE(validate(spec).empty());
}

TEST_CASE("a procedure ends even if the observer never answers", "[procedure]") {
  auto spec = two_down_one_up();
  spec.stop = {};
  spec.stop.reversals = 8;
  const auto procedure = make_procedure(spec, {}, {});
  int asked = 0;
  for (; procedure->next() && asked < 1000; ++asked) {
    CHECK(procedure->next()->level == 20);
    procedure->record(Answer::none);
  }
  CHECK(asked == 80);
  CHECK(procedure->recorded() == 0);
}
