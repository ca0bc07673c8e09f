#include "station/scene/force_carrier.hpp"

#include <cmath>
#include <vector>

#include "station/core/limits.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::scene;

TEST_CASE("the carrier keeps away from the harmonics of mains", "[scene]") {
  for (const double mains : {50.0, 60.0})
    CHECK(std::abs(std::remainder(turnpoint::core::kForceCarrier_Hz, mains)) >= 20);
}

TEST_CASE("the product of tones that is nearest to the carrier is named", "[scene]") {
  const auto nearest = [](std::vector<double> tones) {
    return nearest_product(tones, 10525, 192000).value();
  };
  CHECK(name(nearest({30e3, 33.4e3})) == "3 x 33400 Hz - 3 x 30000 Hz = 10200 Hz");
  CHECK(nearest({30e3, 33.4e3}).distance_Hz == 325);
  CHECK(name(nearest({22.5e3, 34.5e3})) == "2 x 22500 Hz - 34500 Hz = 10500 Hz");
  CHECK(name(nearest({20e3, 65.4e3})) == "4 x 65400 Hz - 4 x 20000 Hz = 181600 Hz, captured at 10400 Hz");
  CHECK(name(nearest({30e3})) == "30000 Hz");
  CHECK_FALSE(nearest_product({}, 10525, 192000));
}
