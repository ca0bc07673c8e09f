#include <cmath>

#include "station/procedure/procedure.hpp"
#include "tests/procedure/watson.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

constexpr int kTrials = 10'000;

enum class Pattern { all_right, all_wrong, alternating };

Answer answer(Pattern pattern, int trial) {
  if (pattern == Pattern::alternating) return trial % 2 ? Answer::one : Answer::zero;
  return pattern == Pattern::all_right ? Answer::one : Answer::zero;
}

/// Runs a procedure for kTrials trials with answers in this pattern. Each level must be finite and inside
/// [low, high], and the estimates at the end must be finite.
void run(const Spec& spec, Pattern pattern, double low, double high) {
  INFO(spec.name << ", pattern " << static_cast<int>(pattern));
  auto endless = spec;
  endless.stop.max_trials = endless.stop.limit_steps = 2 * kTrials;
  const auto procedure = make_procedure(endless, {}, {});
  bool inside = true;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto proposal = procedure->next();
    REQUIRE(proposal.has_value());
    inside = inside && std::isfinite(proposal->level) && proposal->level >= low && proposal->level <= high;
    procedure->record(answer(pattern, trial));
  }
  CHECK(inside);
  CHECK(procedure->recorded() == kTrials);
  for (const auto& [parameter, estimate] : procedure->estimates()) {
    INFO(parameter << " " << estimate.mean << " " << estimate.sd.value_or(0) << " " << estimate.mode);
    CHECK((std::isfinite(estimate.mean) && std::isfinite(estimate.sd.value_or(0)) &&
           std::isfinite(estimate.mode)));
    CHECK(estimate.sd.value_or(0) >= 0);
  }
  if (const auto entropy = procedure->entropy_nats()) CHECK((std::isfinite(*entropy) && *entropy > -1e-9));
}

Spec posterior_spec(Kind kind, Function function, double slope) {
  auto spec = watson_1();
  spec.kind = kind;
  spec.function = function;
  spec.stimuli.values = range(-400, 400, 100);
  spec.threshold.values = range(-400, 400, 80);
  spec.slope.values = {slope};
  if (kind != Kind::quest_plus) spec.slope.values = {0.05, 3.5, 50};
  // With lapse rate 0, slips are impossible in the model. A slip must still not make the posterior 0
  // everywhere.
  spec.lapse.values = {0};
  if (kind == Kind::psi_marginal) spec.lapse.values = {0, 0.04}, spec.nuisance = {"lapse"};
  spec.stop.trials = 2 * kTrials;
  return spec;
}

Spec staircase(Scale scale) {
  Spec spec;
  spec.name = "staircase";
  spec.level = "contrast_dB";
  spec.kind = Kind::up_down;
  spec.scale = scale;
  spec.start = scale == Scale::linear ? 0 : 1;
  spec.step = {50, 0.05};
  spec.n_down = 2;
  spec.stop.trials = 2 * kTrials;
  return spec;
}

}  // namespace

TEST_CASE("a posterior survives ten thousand answers of any kind at levels of 400 dB", "[procedure]") {
  const auto kind = GENERATE(Kind::quest_plus, Kind::psi, Kind::psi_marginal);
  const auto function = GENERATE(Function::weibull, Function::normal, Function::logistic);
  const auto slope = GENERATE(0.05, 3.5, 50.0);
  // these procedures use the same three slopes anyway, so one run is enough
  if (kind != Kind::quest_plus && slope > 0.05) return;
  for (const auto pattern : {Pattern::all_right, Pattern::all_wrong, Pattern::alternating})
    run(posterior_spec(kind, function, slope), pattern, -400, 400);
}

TEST_CASE(
    "if all answers are right, the estimate is the grid's lowest threshold, and if all are wrong, its "
    "highest",
    "[procedure]") {
  for (const auto pattern : {Pattern::all_right, Pattern::all_wrong}) {
    const auto procedure = make_procedure(posterior_spec(Kind::quest_plus, Function::weibull, 3.5), {}, {});
    for (int trial = 0; trial < 200; ++trial) procedure->record(answer(pattern, trial));
    CHECK(procedure->estimates().at("threshold").mode == (pattern == Pattern::all_right ? -400 : 400));
  }
}

TEST_CASE("a procedure ends if nobody answers, whatever its rule for stopping is", "[procedure]") {
  const auto kind = GENERATE(Kind::quest_plus, Kind::psi, Kind::psi_marginal, Kind::zest, Kind::best_pest);
  auto spec = posterior_spec(kind == Kind::zest || kind == Kind::best_pest ? Kind::quest_plus : kind,
                             Function::weibull, 3.5);
  spec.kind = kind;
  spec.stop = {};
  spec.stop.threshold_sd = 1e-6;
  SECTION("any of its conditions") { spec.stop.rule = StopRule::any; }
  SECTION("all of its conditions") {
    spec.stop.rule = StopRule::all;
    spec.stop.trials = 30;
  }
  const auto procedure = make_procedure(spec, {}, {});
  int presented = 0;
  for (; procedure->next() && presented < 1000; ++presented) procedure->record(Answer::none);
  CHECK(presented == kSpentAtMost * (kRepeatsInARow + 1));
}

TEST_CASE("a track with limits stays inside them for ten thousand answers of any kind", "[procedure]") {
  for (const auto pattern : {Pattern::all_right, Pattern::all_wrong, Pattern::alternating}) {
    auto spec = staircase(Scale::linear);
    spec.min = -400, spec.max = 400;
    run(spec, pattern, -400, 400);
    spec.kind = Kind::weighted_up_down;
    spec.n_down = 1;
    spec.target = GENERATE(0.01, 0.75, 0.99);
    run(spec, pattern, -400, 400);
    spec.kind = Kind::accelerated_stochastic_approximation;
    spec.step = {200};
    run(spec, pattern, -400, 400);
  }
}

TEST_CASE("a track with multiplying steps and without limits neither overflows nor reaches zero",
          "[procedure]") {
  for (const auto scale : {Scale::dB, Scale::log10})
    for (const auto pattern : {Pattern::all_right, Pattern::all_wrong, Pattern::alternating})
      for (const auto kind : {Kind::up_down, Kind::accelerated_stochastic_approximation}) {
        auto spec = staircase(scale);
        spec.kind = kind;
        if (kind != Kind::up_down) spec.step = {50}, spec.target = 0.75;
        run(spec, pattern, 1e-300, 1e300);
      }
}
