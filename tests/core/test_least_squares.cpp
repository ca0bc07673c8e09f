#include "station/core/least_squares.hpp"

#include <cmath>

#include "station/core/usage_error.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using core::least_squares;

TEST_CASE("a line fitted to points far from the origin loses no digits", "[analysis]") {
  // The columns 1 and x are nearly equal. Solving the normal equations, which square the condition number,
  // would keep only five digits of the slope.
  std::vector<std::vector<double>> rows;
  std::vector<double> values, weights;
  const double scatter[] = {1, -2, 0, 3, -1, 0, -3, 2, 1, -2, 1};
  double w = 0, wx = 0, wy = 0;
  for (int i = 0; i <= 10; ++i) {
    const double x = 1 + i * std::ldexp(1.0, -20);  // x and the values below are exact in binary
    rows.push_back({1, x});
    values.push_back(2 + 3 * x + scatter[i] * std::ldexp(1.0, -22));
    weights.push_back(1 + i % 3);
    w += weights.back(), wx += weights.back() * i, wy += weights.back() * scatter[i];
  }
  // Compute the expected fit exactly, in whole numbers, with i instead of x and the scatter instead of y.
  double square = 0, product = 0, rest = 0;
  for (int i = 0; i <= 10; ++i) {
    square += weights[i] * (i - wx / w) * (i - wx / w);
    product += weights[i] * (i - wx / w) * (scatter[i] - wy / w);
  }
  const double slope = product / square;
  for (int i = 0; i <= 10; ++i) rest += weights[i] * std::pow(scatter[i] - wy / w - slope * (i - wx / w), 2);
  const auto fit = least_squares(rows, values, weights);
  CHECK(fit.value[1] == Approx(3 + slope / 4).epsilon(1e-9));
  CHECK(fit.known_sd[1] == Approx(std::ldexp(1.0, 20) / std::sqrt(square)).epsilon(1e-9));
  CHECK(fit.sd[1] == Approx(std::sqrt(rest / 9 / square) / 4).epsilon(1e-9));
}

TEST_CASE("a fit to as many points as parameters passes through all points, and has no scatter",
          "[analysis]") {
  const auto fit = least_squares({{1, 0, 0}, {1, 1, 1}, {1, 2, 4}}, {5, 4, 7}, {1, 2, 3});
  CHECK(fit.value[0] == Approx(5));
  CHECK(fit.value[1] == Approx(-3));
  CHECK(fit.value[2] == Approx(2));
  for (const double sd : fit.sd) CHECK(sd == 0);
}

TEST_CASE("columns that do not determine the fit are refused", "[analysis]") {
  const std::vector<double> three{1, 2, 3}, ones{1, 1, 1};
  CHECK_THROWS_AS(least_squares({{1, 2}, {1, 2}, {1, 2}}, three, ones), core::UsageError);
  CHECK_THROWS_AS(least_squares({{1, 0}, {1, 0}, {1, 0}}, three, ones), core::UsageError);
  CHECK_THROWS_AS(least_squares({{1, 2, 3}}, {1}, {1}), core::UsageError);
  CHECK_THROWS_AS(least_squares({{1, 2}, {1, 3}, {1, 4}}, three, {1, 0, 0}), core::UsageError);
  CHECK_NOTHROW(least_squares({{1, 2}, {1, 3}, {1, 4}}, three, ones));
}
