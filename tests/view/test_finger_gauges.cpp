#include <limits>

#include "station/view/live_facts.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

rig::Rig rig_of_300_mm() {
  rig::Rig rig;
  rig.surface.length_m = 0.3;
  return rig;
}

}  // namespace

TEST_CASE("the operator's gauges show force, speed and place of the finger, without anything in the protocol",
          "[desk][gauges]") {
  const auto gauges = view::finger_gauges(session::FingerSeen{0.5, -80, 150}, {}, rig_of_300_mm());
  CHECK(gauges.force.value.value() == Approx(0.25));
  CHECK(gauges.force.figure == "0.50 N");
  CHECK(gauges.force.low == gauges.force.high);  // no range is asked for
  CHECK(gauges.speed.value.value() == Approx(0.4));
  CHECK(gauges.speed.figure == "80 mm/s");
  CHECK(gauges.position.value.value() == Approx(0.5));
  CHECK(gauges.position.figure == "150 mm");
}

TEST_CASE("the operator's gauges have the ranges that the protocol asks for, with or without guidance",
          "[desk][gauges]") {
  protocol::Sensing asked;
  asked.normal_N = std::pair(0.4, 0.8);
  const auto gauges = view::finger_gauges(session::FingerSeen{0.6, 80, 30}, asked, rig_of_300_mm());
  CHECK(gauges.force.value.value() == Approx(0.5));
  CHECK(gauges.force.low == Approx(1.0 / 3));
  CHECK(gauges.force.high == Approx(2.0 / 3));
  CHECK(gauges.speed.value.value() == Approx(0.4));
}

TEST_CASE("gauges are empty without a finger, and what is not known is not shown", "[desk][gauges]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto empty = view::finger_gauges({}, {}, rig_of_300_mm());
  CHECK_FALSE(empty.force.value);
  CHECK(empty.force.figure.empty());
  CHECK_FALSE(empty.position.value);
  const auto resting = view::finger_gauges(session::FingerSeen{9, nan, nan}, {}, rig_of_300_mm());
  CHECK(resting.force.value.value() == 1);  // the end of the scale
  CHECK(resting.force.figure == "9.00 N");
  CHECK_FALSE(resting.speed.value);
  CHECK_FALSE(resting.position.value);
}
