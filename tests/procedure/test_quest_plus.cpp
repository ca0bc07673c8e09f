#include <cmath>

#include "station/procedure/posterior.hpp"
#include "station/procedure/psychometric.hpp"
#include "station/procedure/trace.hpp"
#include "tests/procedure/watson.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

TEST_CASE("Watson's first example is reproduced trial by trial", "[procedure]") {
  const auto result = trace(watson_1(), {}, "11110011111111011011011111111111");
  const std::vector<double> published{-18, -22, -25, -28, -30, -22, -13, -15, -16, -18, -19,
                                      -20, -21, -22, -23, -19, -20, -20, -18, -18, -19, -17,
                                      -17, -18, -18, -18, -19, -19, -19, -19, -19, -19};
  CHECK(result.levels == published);
  const auto threshold = result.estimates.at("threshold");
  CHECK(threshold.mode == -20);
  CHECK(threshold.mean == Approx(-20.3936).margin(5e-5));
  CHECK(threshold.sd == Approx(1.38933).margin(5e-6));
  CHECK(*result.entropy_nats == Approx(1.68350).margin(5e-6));
}

TEST_CASE("negative control: with a higher likelihood floor, the levels differ from Watson's",
          "[procedure]") {
  auto spec = watson_1();
  spec.lapse.values = {0.03};
  CHECK(trace(spec, {}, "11110011111111011011011111111111").levels !=
        trace(watson_1(), {}, "11110011111111011011011111111111").levels);
}

TEST_CASE("the most informative stimulus is that of a direct computation of the expected entropy",
          "[procedure]") {
  Spec spec = watson_1();
  spec.slope.values = {1, 2, 4};
  spec.lapse.values = {0.01, 0.04};
  spec.threshold.values = range(-30, -10, 2);
  spec.stimuli.values = range(-40, 0, 4);
  Posterior posterior(spec);
  for (const int answer : {1, 1, 0, 1, 0, 1, 1}) {
    const auto information = posterior.information();
    for (std::size_t i = 0; i < information.size(); ++i) {
      auto one = posterior, zero = posterior;
      one.update(i, true);
      zero.update(i, false);
      const double p = posterior.predictive(i);
      const double expected = p * one.entropy_nats() + (1 - p) * zero.entropy_nats();
      CHECK(information[i] == Approx(posterior.entropy_nats() - expected).margin(1e-12));
    }
    posterior.update(posterior.best_stimulus(), answer == 1);
  }
}

TEST_CASE("grids whose steps do not agree give the same information as grids that share distances",
          "[procedure]") {
  // On the second grid no two stimuli have the same distances from the thresholds. The results may differ
  // only by rounding.
  auto shared = watson_1(), apart = watson_1();
  shared.slope.values = apart.slope.values = {1, 2.5, 4};
  shared.lapse.values = apart.lapse.values = {0.01, 0.03};
  double moved = 0;
  for (auto& value : apart.threshold.values) value += moved += 1e-11;
  Posterior a(shared), b(apart);
  CHECK(b.memory_bytes() > 5 * a.memory_bytes());
  for (int trial = 0; trial < 12; ++trial) {
    const auto one = a.information(), other = b.information();
    for (std::size_t i = 0; i < one.size(); ++i) CHECK(one[i] == Approx(other[i]).margin(1e-9));
    a.update(5 * (trial % 8), trial % 3 != 0), b.update(5 * (trial % 8), trial % 3 != 0);
  }
}

TEST_CASE("psychometric functions agree with libm and stay finite at every extreme", "[procedure]") {
  for (double z = -37; z <= 37; z += 0.37)
    CHECK(normal_cdf(z) == Approx(0.5 * std::erfc(-z / std::sqrt(2.0))).epsilon(1e-12));
  const Psychometric p{-20, 3.5, 0.5, 0.02};
  CHECK(probability(Function::weibull, Scale::linear, p, -20) ==
        Approx(0.98 - 0.48 * std::exp(-1.0)).epsilon(1e-14));
  for (const double slope : {0.05, 1.0, 50.0})
    for (const double level : {-400.0, -20.0, 0.0, 400.0})
      for (const auto function : {Function::weibull, Function::normal, Function::logistic}) {
        const double value = probability(function, Scale::linear, {-20, slope, 0.5, 0}, level);
        CHECK((value >= 0.5 && value <= 1));
      }
}

TEST_CASE("an unanswered trial is repeated at the same level, and four in a row cost one trial",
          "[procedure]") {
  auto spec = watson_1();
  spec.stop.trials = 2;
  const auto procedure = make_procedure(spec, {}, {});
  const double level = procedure->next()->level;
  for (int i = 0; i < 7; ++i) {
    procedure->record(Answer::none);
    REQUIRE(procedure->next().has_value());
    CHECK(procedure->next()->level == level);
  }
  procedure->record(Answer::none);
  CHECK_FALSE(procedure->next().has_value());
  CHECK(procedure->recorded() == 0);
}

TEST_CASE("psi-marginal learns about the kept parameters and sums over the nuisance parameters",
          "[procedure]") {
  Spec spec;
  spec.name = "psi";
  spec.level = "spread_mm";
  spec.kind = Kind::psi_marginal;
  spec.scale = Scale::log10;
  for (int i = 0; i < 25; ++i) spec.stimuli.values.push_back(2 * std::pow(20, i / 24.0));
  for (int i = 0; i < 41; ++i) spec.threshold.values.push_back(2 * std::pow(20, i / 40.0));
  spec.slope.values = {0.5, 1, 2, 4, 8};
  spec.guess.values = {1.0 / 3};
  spec.lapse.values = {0.01, 0.02, 0.04, 0.06};
  spec.stop.trials = 400;
  auto with = spec;
  with.nuisance = {"lapse"};
  Posterior all(spec), kept(with);
  const auto a = all.information(), b = kept.information();
  // With the lapse rate as a nuisance parameter, no stimulus can be expected to give more information.
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(b[i] <= a[i] + 1e-12);
  // The estimate must find the threshold of 10 mm and the slope of 2 of the simulated observer.
  const auto procedure = make_procedure(with, {}, {});
  turnpoint::core::Draws draws({3, turnpoint::core::Stream::observer, 0, 0, 0});
  while (const auto proposal = procedure->next()) {
    const double p = probability(Function::weibull, Scale::log10, {10, 2, 1.0 / 3, 0.02}, proposal->level);
    procedure->record(draws.uniform() < p ? Answer::one : Answer::zero);
  }
  CHECK(procedure->estimates().at("threshold").mean == Approx(10).epsilon(0.2));
}
