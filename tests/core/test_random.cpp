#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "station/core/draws.hpp"
#include "station/core/elementary.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::core;

TEST_CASE("Philox gives the published values", "[random]") {
  using Words = std::array<std::uint32_t, 4>;
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
}

TEST_CASE("draws depend on their key alone, and every part of the key matters", "[random]") {
  const DrawKey key{42, Stream::roving, 1, 0, 7};
  CHECK(Draws(key).bits() == Draws(key).bits());
  std::set<std::uint64_t> first;
  for (const auto& other : {key, DrawKey{43, Stream::roving, 1, 0, 7}, DrawKey{42, Stream::observer, 1, 0, 7},
                            DrawKey{42, Stream::roving, 2, 0, 7}, DrawKey{42, Stream::roving, 1, 1, 7},
                            DrawKey{42, Stream::roving, 1, 0, 8}})
    first.insert(Draws(other).bits());
  CHECK(first.size() == 6);
}

TEST_CASE("uniform, below and normal have the moments of their distributions", "[random]") {
  Draws draws({1, Stream::bootstrap, 0, 0, 0});
  double sum = 0, squares = 0, normal_sum = 0, normal_squares = 0;
  std::map<std::uint64_t, int> counts;
  const int n = 200'000;
  for (int i = 0; i < n; ++i) {
    const double u = draws.uniform(), z = draws.normal();
    sum += u, squares += u * u, normal_sum += z, normal_squares += z * z;
    ++counts[draws.below(7)];
  }
  // The tolerances are five standard errors.
  CHECK(sum / n == Approx(0.5).margin(5 * 0.2887 / std::sqrt(n)));
  CHECK(squares / n == Approx(1.0 / 3).margin(5 * 0.298 / std::sqrt(n)));
  CHECK(normal_sum / n == Approx(0).margin(5 / std::sqrt(n)));
  CHECK(normal_squares / n == Approx(1).margin(5 * std::sqrt(2.0 / n)));
  CHECK(counts.size() == 7);
  for (const auto& [value, count] : counts) CHECK(count == Approx(n / 7.0).margin(5 * std::sqrt(n / 7.0)));
}

TEST_CASE("a shuffle gives every permutation equally often", "[random]") {
  std::map<std::vector<int>, int> counts;
  for (int trial = 0; trial < 24'000; ++trial) {
    std::vector<int> items{0, 1, 2, 3};
    Draws({5, Stream::level_order, 0, 0, trial}).shuffle(items);
    ++counts[items];
  }
  CHECK(counts.size() == 24);
  for (const auto& [items, count] : counts) CHECK(count == Approx(1000).margin(160));
}

TEST_CASE("log and exp agree with libm to the last bits and refuse arguments without a result", "[random]") {
  Draws draws({9, Stream::bootstrap, 0, 0, 0});
  for (int i = 0; i < 20'000; ++i) {
    const double x = draws.uniform(-700, 700);
    CHECK(turnpoint::core::exp(x) == Approx(std::exp(x)).epsilon(1e-15));
    const double y = std::exp(x);
    CHECK(std::fabs(turnpoint::core::log(y) - std::log(y)) <= 4e-16 * std::max(1.0, std::fabs(std::log(y))));
  }
  CHECK(turnpoint::core::log(1) == 0);
  CHECK(turnpoint::core::exp(-1000) == 0);
  CHECK_THROWS_AS(turnpoint::core::log(0), std::domain_error);
  CHECK_THROWS_AS(turnpoint::core::exp(710), std::domain_error);
}

namespace {

/// Computes the logarithm by the same series as the program's log(), but takes the exponent from libm.
double log_by_frexp(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < 0.70710678118654752) m *= 2, --exponent;
  const double z = (m - 1) / (m + 1), z2 = z * z;
  double sum = 0;
  for (int k = 11; k >= 1; --k) sum = z2 * (1.0 / (2 * k + 1) + sum);
  return exponent * 6.93147180369123816490e-01 +
         (2 * z + (2 * z * sum + exponent * 1.90821492927058770002e-10));
}

}  // namespace

TEST_CASE("log and logs give the same bits as the series, for every kind of number", "[random]") {
  std::vector<double> numbers{5e-324, 2.2250738585072009e-308, 2.2250738585072014e-308,
                              1.7976931348623157e308};
  Draws draws({10, Stream::bootstrap, 0, 0, 0});
  for (int exponent = -1074; exponent < 1024; ++exponent)
    for (const double m : {1.0, std::sqrt(2.0), draws.uniform(1, 2), draws.uniform(1, 2)}) {
      const double x = std::ldexp(m, exponent);
      for (const double near : {std::nextafter(x, 0), x, std::nextafter(x, 2 * x)})
        if (near > 0 && std::isfinite(near)) numbers.push_back(near);
    }
  std::vector<double> expected, one_by_one, together(numbers.size());
  for (const double x : numbers)
    expected.push_back(log_by_frexp(x)), one_by_one.push_back(turnpoint::core::log(x));
  turnpoint::core::logs(numbers, together);
  CHECK(one_by_one == expected);
  CHECK(together == expected);
  for (const double without : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    numbers[17] = without;
    CHECK_THROWS_AS(turnpoint::core::logs(numbers, together), std::domain_error);
  }
}

TEST_CASE("the normal distribution function agrees with another implementation to 1e-15", "[random]") {
  for (double x = -9; x <= 9; x += 0.0625)
    CHECK(normal_cdf(x) == Approx(0.5 * std::erfc(-x / std::sqrt(2.0))).margin(1e-15));
  CHECK(normal_cdf(0) == 0.5);
}
