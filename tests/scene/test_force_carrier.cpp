#include "station/scene/force_carrier.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"

using namespace turnpoint::scene;

TEST_CASE("the carrier keeps away from mains and from products of the drive tones", "[scene]") {
  for (const double carrier : carriers_Hz)
    for (const double mains : {50.0, 60.0}) CHECK(std::abs(std::remainder(carrier, mains)) >= 20);
  const auto choose = [](std::vector<std::vector<double>> plans) { return choose_carrier(plans, 192000); };
  CHECK(choose({}).carrier_Hz == 10525);
  CHECK(choose({{30e3}}).carrier_Hz == 10525);
  // the tones' intermodulation products are at 2, 4, 6, 8, 28, 34 kHz
  CHECK(choose({{30e3, 32e3}}).carrier_Hz == 10525);
  // For the two tones of 30 and 33.4 kHz, an intermodulation product at three times their difference is only
  // 325 Hz below the default carrier.
  const auto moved = choose({{30e3, 33.4e3}});
  CHECK(moved.carrier_Hz != 10525);
  CHECK(moved.clearance_Hz >= enough_clearance_Hz);
  // the same tones in two different stimuli never sound together, so they have no intermodulation products
  CHECK(choose({{30e3}, {33.4e3}}).carrier_Hz == 10525);
  const auto crowded = choose({{22.4e3, 23.5e3, 25e3, 27e3}});
  CHECK(crowded.clearance_Hz < enough_clearance_Hz);
  for (const double carrier : carriers_Hz) {
    double nearest = 1e9;
    for (const double product :
         {1.1e3, 2.2e3, 3.3e3, 4.4e3, 2.6e3, 5.2e3, 7.8e3,  10.4e3, 4.6e3, 9.2e3, 13.8e3, 18.4e3,
          1.5e3, 3e3,   4.5e3, 6e3,   3.5e3, 7e3,   10.5e3, 14e3,   2e3,   4e3,   8e3,    17.8e3})
      nearest = std::min(nearest, std::abs(carrier - product));
    CHECK(crowded.clearance_Hz >= nearest);
  }
  // The intermodulation product 4 x (65.4 - 20) kHz aliases at 192 kHz to 10.4 kHz, too close to 10525 Hz.
  CHECK(choose({{20e3, 65.4e3}}).carrier_Hz != 10525);
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
