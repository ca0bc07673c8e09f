#include "physics/root.hpp"

#include <cmath>
#include <limits>

#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const auto never = [](const auto&) { return false; };

}  // namespace

TEST_CASE("halving ends when no number is left between the ends, whichever end has the positive value",
          "[root]") {
  const auto is_above = [](double x) { return x * x > 2; };
  const auto falling = [](double x) { return x * x < 2; };
  const auto right = bisect({2, 0}, is_above), left = bisect({0, 2}, falling);
  CHECK(right.above == std::nextafter(right.not_above, 2));
  CHECK(right.not_above * right.not_above <= 2);
  CHECK(left.above == right.not_above);
  CHECK(left.not_above == right.above);
}

TEST_CASE("bisection stops at the given width, and near 0 after a fixed number of steps", "[root]") {
  const auto is_above = [](double x) { return x > 0; };
  CHECK(bisect({1, -3}, is_above, [](const Bracket& b) { return b.width() <= 0.5; }).width() == 0.5);
  CHECK(bisect({1, 0}, is_above).above == std::ldexp(1.0, -200));
}

TEST_CASE("Newton steps find a root to rounding and stay inside the bracket", "[root]") {
  const auto tangent = [](double x) {
    return Tangent{std::cos(x) - x, x + (std::cos(x) - x) / (std::sin(x) + 1)};
  };
  const auto close = [](double next, double x) { return std::abs(next - x) <= 1e-16; };
  CHECK(newton({0, 1}, 0.5, tangent, close) == Approx(0.73908513321516064).epsilon(1e-15));
  // From 3, Newton steps for atan diverge and leave every bracket, so the search must halve the bracket
  // first.
  const auto leaves = [](double x) {
    CHECK((x > -4 && x < 5));
    return Tangent{std::atan(x), x - std::atan(x) * (1 + x * x)};
  };
  CHECK(std::abs(newton({5, -4}, 3, leaves, close)) < 1e-15);
}

TEST_CASE(
    "Newton steps end at a point where the function is 0, and go to the middle if the tangent has no root",
    "[root]") {
  int calls = 0;
  const auto tangent = [&calls](double x) {
    ++calls;
    return Tangent{x - 0.25, kNan};
  };
  const auto close = [](double next, double x) { return next == x; };
  CHECK(newton({1, 0}, 0.5, tangent, close) == 0.25);
  CHECK(calls == 2);
}

TEST_CASE("false position needs few steps even if one end hardly moves", "[root]") {
  // For f = x^9 - .5 on [0, 2], plain false position moves only the left end and converges slowly.
  for (const bool halve_values : {false, true}) {
    int calls = 0;
    const auto f = [&calls](double x) { return ++calls, std::pow(x, 9) - 0.5; };
    const double x = false_position({0, -0.5, 2, 511.5}, f, {3, halve_values}, 0, never);
    CHECK(x == Approx(std::pow(0.5, 1.0 / 9)).epsilon(1e-15));
    CHECK(calls < 100);
  }
}

TEST_CASE("false position works on falling functions and stops when the value is small enough", "[root]") {
  int calls = 0;
  const auto f = [&calls](double x) { return ++calls, 1 - x * x; };
  const double x = false_position({0, 1, 3, -8}, f, {8, true}, 1e-6, never);
  CHECK(std::abs(1 - x * x) <= 1e-6);
  CHECK(calls < 12);
  const auto wide = [](const Chord& c) { return c.width() < 4; };
  // the bracket is narrow enough at once, so its middle is returned
  CHECK(false_position({0, 1, 3, -8}, f, {8, true}, 0, wide) == 1.5);
}

TEST_CASE("false position treats NaN as a value that is not above 0, and ends", "[root]") {
  const double x = false_position(
      {0, -1, 1, 1}, [](double) { return kNan; }, {3}, 0, never);
  CHECK((x > 0 && x <= 1));
}
