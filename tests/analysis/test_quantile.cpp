#include "station/analysis/quantile.hpp"

#include <stdexcept>

#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

TEST_CASE("Student's t has the tabulated quantiles", "[analysis]") {
  const double table[][2] = {{1, 12.706}, {2, 4.303}, {3, 3.182}, {5, 2.571}, {10, 2.228}, {1e6, 1.960}};
  for (const auto& [degrees, t] : table)
    CHECK(student_t_975(static_cast<int>(degrees)) == Approx(t).epsilon(0.008));
  CHECK_THROWS_AS(student_t_975(0), std::invalid_argument);
}
