#include "physics/airy.hpp"

#include <cmath>

#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

TEST_CASE(
    "Ai and its derivative match a table computed with fifty digits, for positive and negative arguments",
    "[physics][oracle]") {
  const auto rows = turnpoint::physics_test::oracle("airy.csv");
  REQUIRE(rows.size() > 100);
  for (const auto& row : rows) {
    const double t = std::stod(row[0]), ai = std::stod(row[1]), dai = std::stod(row[2]),
                 ln = std::stod(row[3]);
    const Airy y = airy(t);
    CAPTURE(t, y.ai, y.dai, y.ln_scale, ai, dai, ln);
    const double factor = std::exp(y.ln_scale - ln);
    const double root = std::sqrt(std::sqrt(std::max(1.0, std::abs(t))));
    // The argument is rounded to a double, which limits the accuracy of the oscillation's phase.
    const double allowed = 2e-14 + 4e-16 * std::pow(std::abs(t), 1.5);
    CHECK(std::abs(y.ai * factor - ai) <= allowed * (t > 0 ? std::abs(ai) : 1 / root));
    CHECK(std::abs(y.dai * factor - dai) <= allowed * (t > 0 ? std::abs(dai) : root));
  }
}

TEST_CASE("the last maximum of Ai lies where its derivative vanishes", "[physics]") {
  CHECK(std::abs(airy(airy_last_peak).dai) < 1e-15);
  CHECK(std::abs(airy(airy_last_peak + 1e-6).dai) > 1e-7);
}
