#include "station/analysis/rating_fit.hpp"

#include <cmath>
#include <stdexcept>

#include "station/analysis/proportion.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/core/draws.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::analysis;

namespace {

const std::vector<int> kNoise{174, 172, 104, 92, 41, 8}, kSignal{46, 57, 66, 101, 154, 173};

TrialRecord rated(int rating, bool present, double level, const std::string& condition = "") {
  TrialRecord trial;
  trial.response = rating, trial.present = present, trial.level = level, trial.instruction = condition;
  return trial;
}

}  // namespace

TEST_CASE("with two ratings, the fit is the d' of yes and no", "[analysis]") {
  const auto fit = fit_ratings({70, 30}, {20, 80}, Variances::equal);
  REQUIRE(fit);
  CHECK(fit->sensitivity.value == Approx(normal_quantile(0.8) - normal_quantile(0.3)));
  REQUIRE(fit->criteria.size() == 1);
  CHECK(fit->criteria[0] == Approx(-normal_quantile(0.3)));
  CHECK_FALSE(fit_ratings({70, 30}, {20, 80}, Variances::unequal));  // two points do not show a variance
}

TEST_CASE("with three ratings, unequal variances follow from the line through both points", "[analysis]") {
  const auto fit = fit_ratings({50, 30, 20}, {15, 25, 60}, Variances::unequal);
  REQUIRE(fit);
  const double strict_f = normal_quantile(0.2), lax_f = normal_quantile(0.5), strict_h = normal_quantile(0.6),
               lax_h = normal_quantile(0.85);
  const double slope = (lax_h - strict_h) / (lax_f - strict_f), intercept = lax_h - slope * lax_f;
  CHECK(fit->sd.value == Approx(1 / slope));
  CHECK(fit->mean == Approx(intercept / slope));
  CHECK(fit->sensitivity.value == Approx(intercept * std::sqrt(2 / (1 + slope * slope))));
  CHECK(fit->area.value == Approx(normal_cdf(intercept / std::sqrt(1 + slope * slope))));
  CHECK(fit->criteria[0] == Approx(-lax_f).margin(1e-6));
  CHECK(fit->criteria[1] == Approx(-strict_f));
}

TEST_CASE("fits of ratings are those of SciPy", "[analysis]") {  // numbers from make_rating_fit.py
  const auto equal = fit_ratings(kNoise, kSignal, Variances::equal);
  REQUIRE(equal);
  CHECK(equal->sensitivity.value == Approx(1.2531771).epsilon(1e-5));
  CHECK(equal->sensitivity.interval.high - equal->sensitivity.value == Approx(0.1282082).epsilon(1e-4));
  CHECK(equal->log_likelihood == Approx(-1936.7299526).epsilon(1e-9));
  const auto unequal = fit_ratings(kNoise, kSignal, Variances::unequal);
  REQUIRE(unequal);
  CHECK(unequal->mean == Approx(1.5190519).epsilon(1e-5));
  CHECK(unequal->sensitivity.value == Approx(1.2387338).epsilon(1e-5));
  CHECK(unequal->sensitivity.value - unequal->sensitivity.interval.low == Approx(0.1306036).epsilon(1e-4));
  CHECK(unequal->sd.value == Approx(1.4168960).epsilon(1e-5));
  CHECK(std::log(unequal->sd.interval.high / unequal->sd.value) ==
        Approx(1.959964 * 0.0890951 / 1.4168960).epsilon(1e-4));
  CHECK(unequal->area.value == Approx(0.8094624).epsilon(1e-6));
  CHECK(unequal->log_likelihood == Approx(-1920.9847422).epsilon(1e-9));
  const double criteria[] = {-0.533099, 0.204176, 0.709946, 1.366345, 2.294002};
  REQUIRE(unequal->criteria.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) CHECK(unequal->criteria[i] == Approx(criteria[i]).margin(2e-5));
  // a rating that was never given has no criterion
  const auto sparse = fit_ratings({30, 22, 0, 10, 5}, {6, 11, 0, 21, 29}, Variances::unequal);
  REQUIRE(sparse);
  CHECK(sparse->criteria.size() == 3);
  CHECK(sparse->sensitivity.value == Approx(1.3091482).epsilon(1e-5));
  CHECK(sparse->sd.value == Approx(1.0455091).epsilon(1e-5));
}

TEST_CASE("noise and signal exchanged turn the sign of the sensitivity", "[analysis]") {
  const auto fit = fit_ratings(kSignal, kNoise, Variances::equal);
  REQUIRE(fit);
  CHECK(fit->sensitivity.value == Approx(-1.2531771).epsilon(1e-5));
  CHECK(fit->area.value == Approx(1 - 0.8122263).epsilon(1e-5));
  const auto unequal = fit_ratings(kSignal, kNoise, Variances::unequal);
  REQUIRE(unequal);
  CHECK(unequal->sensitivity.value == Approx(-1.2387338).epsilon(1e-5));
  CHECK(unequal->sd.value == Approx(1 / 1.4168960).epsilon(1e-5));
}

TEST_CASE("answers that do not determine the distributions have no fit", "[analysis]") {
  for (const auto variances : {Variances::equal, Variances::unequal}) {
    CHECK_FALSE(fit_ratings({0, 0, 0}, {1, 2, 3}, variances));
    CHECK_FALSE(fit_ratings({10, 0, 0}, {10, 0, 0}, variances));
    CHECK_FALSE(fit_ratings({20, 10, 0, 0}, {0, 0, 10, 20}, variances));  // complete separation
  }
  // With these, the likelihood rises with the standard deviation and with the criteria, without an end.
  CHECK_FALSE(fit_ratings({47, 13, 0, 0, 0, 0}, {4, 5, 2, 0, 0, 9}, Variances::unequal));
  CHECK_THROWS_AS(fit_ratings({1, 2}, {1, 2, 3}, Variances::equal), std::invalid_argument);
  CHECK_THROWS_AS(fit_ratings({1, -2}, {1, 2}, Variances::equal), std::invalid_argument);
}

TEST_CASE("fits of small samples are finite, and their intervals contain the true value as often as they say",
          "[analysis]") {
  core::Draws draws({4, core::Stream::observer, 0, 0, 0});
  const double mean = 1.2, sd = 1.3, truth = mean / std::sqrt((1 + sd * sd) / 2);
  int fitted = 0, held = 0, sd_held = 0;
  for (int study = 0; study < 400; ++study) {
    std::vector<int> noise(6), signal(6);
    for (int trial = 0; trial < 240; ++trial) {
      const double felt = normal_quantile(draws.uniform());
      const double at = trial % 2 == 0 ? felt : mean + sd * felt;
      std::size_t rating = 0;
      for (const double criterion : {-0.6, 0.0, 0.6, 1.2, 1.8}) rating += at > criterion ? 1 : 0;
      ++(trial % 2 == 0 ? noise : signal)[rating];
    }
    const auto fit = fit_ratings(noise, signal, Variances::unequal);
    if (!fit) continue;
    ++fitted;
    const auto& range = fit->sensitivity.interval;
    held += range.low <= truth && truth <= range.high ? 1 : 0;
    sd_held += fit->sd.interval.low <= sd && sd <= fit->sd.interval.high ? 1 : 0;
  }
  CHECK(fitted >= 396);
  CHECK(held >= 0.92 * fitted);  // 95 % would be 380 of 400, with a standard deviation of 4.4
  CHECK(held <= 0.98 * fitted);
  CHECK(sd_held >= 0.92 * fitted);
}

TEST_CASE("ratings of trials with and without a signal have a curve at each level", "[analysis]") {
  std::vector<TrialRecord> trials;
  for (int rating = 0; rating < 6; ++rating) {
    const auto at = static_cast<std::size_t>(rating);
    for (int k = 0; k < kNoise[at]; ++k) trials.push_back(rated(rating, false, 0));
    for (int k = 0; k < kSignal[at]; ++k) trials.push_back(rated(rating, true, k % 2 == 0 ? 1 : 2));
  }
  auto practice = rated(5, false, 0);
  practice.type = TrialType::practice;
  trials.push_back(practice);
  auto late = rated(5, false, 0);
  late.outcome = Outcome::timeout;
  trials.push_back(late);
  const auto curves = rating_rocs(trials, {}, 6);
  REQUIRE(curves.size() == 3);
  CHECK(curves[0].level == 1);
  CHECK(curves[1].level == 2);
  CHECK_FALSE(curves[2].level);
  CHECK(curves[2].noise == kNoise);
  CHECK(curves[2].signal == kSignal);
  CHECK(curves[0].noise == kNoise);  // all levels share the noise
  CHECK(curves[2].roc.area.value == roc(kNoise, kSignal)->area.value);
  CHECK(curves[2].roc.area.value > 0.7);
  REQUIRE(curves[2].unequal);
  CHECK(curves[2].unequal->sd.value == Approx(1.4168960).epsilon(1e-5));
  for (auto& trial : trials) trial.present.reset();
  CHECK(rating_rocs(trials, {}, 6).empty());
}
