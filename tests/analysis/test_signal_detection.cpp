#include <cmath>

#include "station/analysis/proportion.hpp"
#include "station/analysis/signal_detection.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

TEST_CASE("Wilson and Clopper-Pearson intervals of 15 of 20 are the published ones", "[analysis]") {
  const auto score = wilson(15, 20);
  CHECK(score.low == Approx(0.531299).margin(5e-7));
  CHECK(score.high == Approx(0.888138).margin(5e-7));
  const auto exact = clopper_pearson(15, 20);
  CHECK(exact.low == Approx(0.508954).margin(5e-7));
  CHECK(exact.high == Approx(0.913429).margin(5e-7));
}

TEST_CASE("Intervals of a proportion stay inside 0 to 1 and mirror each other", "[analysis]") {
  for (const int n : {1, 2, 7, 400})
    for (int k = 0; k <= n; ++k)
      for (const auto make : {wilson, clopper_pearson}) {
        const auto interval = make(k, n, 0.95), mirrored = make(n - k, n, 0.95);
        CHECK(interval.low >= 0);
        CHECK(interval.high <= 1);
        CHECK(interval.low <= double(k) / n);
        CHECK(interval.high >= double(k) / n);
        CHECK(interval.low == Approx(1 - mirrored.high).margin(1e-12));
      }
  CHECK(clopper_pearson(0, 10).high == Approx(1 - std::pow(0.025, 0.1)).epsilon(1e-12));
  CHECK_THROWS_AS(wilson(3, 2), std::invalid_argument);
  CHECK_THROWS_AS(clopper_pearson(0, 0), std::invalid_argument);
}

TEST_CASE("Clopper-Pearson covers at least as often as it says, a plain normal interval does not",
          "[analysis]") {
  const auto covered = [](double p, int n, auto interval) {
    double sum = 0, mass = std::pow(1 - p, n);
    for (int k = 0; k <= n; ++k) {
      const auto i = interval(k, n);
      if (i.low <= p && p <= i.high) sum += mass;
      mass *= (n - k) / (k + 1.0) * p / (1 - p);
    }
    return sum;
  };
  const auto exact = [](int k, int n) { return clopper_pearson(k, n); };
  const auto normal = [](int k, int n) {
    const double p = double(k) / n, half = 1.96 * std::sqrt(p * (1 - p) / n);
    return Interval{p - half, p + half, 0.95};
  };
  for (const double p : {0.02, 0.3, 0.5, 0.93}) CHECK(covered(p, 24, exact) >= 0.95);
  CHECK(covered(0.02, 24, normal) < 0.5);
}

TEST_CASE("d' of forced choice is sqrt 2 z, of a single interval 2 z", "[analysis]") {
  CHECK(*d_prime_forced_choice(0.75) == Approx(0.9539).margin(5e-5));
  CHECK(*d_prime_single_interval_unbiased(0.75) == Approx(2 * 0.6744897501960817).epsilon(1e-12));
  CHECK(*d_prime_forced_choice(0.5) == Approx(0).margin(1e-15));
  CHECK_FALSE(d_prime_forced_choice(1).has_value());
  CHECK_FALSE(d_prime_forced_choice(0).has_value());
  CHECK_THROWS_AS(d_prime_forced_choice(1.2), std::invalid_argument);
}

TEST_CASE("Yes/no sensitivity with the log-linear correction is finite for perfect rates", "[analysis]") {
  const auto perfect = yes_no({20, 0, 0, 20});
  REQUIRE(perfect);
  CHECK(perfect->hit_rate == Approx(20.5 / 21));
  CHECK(perfect->d_prime == Approx(2 * normal_quantile(20.5 / 21)));
  CHECK(perfect->criterion == Approx(0).margin(1e-12));
  const auto shy = yes_no({5, 15, 1, 19});
  CHECK(shy->criterion > 0.5);
  CHECK_FALSE(yes_no({0, 0, 3, 4}).has_value());
}

TEST_CASE("The normal quantile inverts the distribution function", "[analysis]") {
  for (const double z : {-6.0, -2.0, -0.1, 0.0, 1.0, 5.0})
    CHECK(normal_quantile(normal_cdf(z)) == Approx(z).margin(1e-9));
  CHECK_THROWS_AS(normal_quantile(0), std::invalid_argument);
}
