#include "station/rig/calibration.hpp"
#include "station/rig/panel_latency.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::rig;

namespace {
constexpr std::int64_t ms = 1'000'000, s = 1000 * ms;
}

TEST_CASE(
    "a panel's latency is the median time from the button to the touch, and its jitter is their scatter",
    "[panel]") {
  std::vector<std::int64_t> edges, touches;
  for (int k = 0; k < 12; ++k) {
    edges.push_back(k * s);
    touches.push_back(k * s + (60 + k % 3) * ms);  // each touch follows its edge by 60, 61 or 62 ms
  }
  const auto delay = pair_delays(touches, edges, LatencyReference::button);
  REQUIRE(delay);
  CHECK(delay->pairs == 12);
  CHECK(delay->unmatched == 0);
  CHECK(delay->median_s == Approx(0.061));
  CHECK(delay->sd_s == Approx(0.000853).epsilon(1e-3));
  // A photodiode responds after the touch, so edges before a touch must not be matched with it.
  CHECK_FALSE(pair_delays(touches, edges, LatencyReference::photodiode));
  CHECK(pair_delays(edges, touches, LatencyReference::photodiode)->median_s == Approx(0.061));
}

TEST_CASE("a touch without exactly one edge near it counts as unmatched", "[panel]") {
  const std::vector<std::int64_t> edges{1 * s, 2 * s, 3 * s, 3 * s + 100 * ms};
  const std::vector<std::int64_t> touches{1 * s + 50 * ms, 2 * s + 50 * ms, 3 * s + 150 * ms, 4 * s};
  const auto delay = pair_delays(touches, edges, LatencyReference::button);
  REQUIRE(delay);
  CHECK(delay->pairs == 2);
  CHECK(delay->unmatched == 2);
  CHECK(delay->median_s == Approx(0.05));
}

TEST_CASE("a calibration keeps the panel's latency, and is valid even if nothing else was measured",
          "[panel]") {
  Calibration calibration;
  calibration.rig_name = "plate";
  calibration.rig_sha256 = "abc";
  calibration.made_on = "2026-03-01";
  CHECK(problems(calibration, "abc", "2026-03-02").size() == 1);
  calibration.panel = PanelLatency{"2026-03-02", "kernel", Delay{0.0625, 0.004, 40, 1}, std::nullopt};
  CHECK(problems(calibration, "abc", "2026-03-02").empty());
  const auto again = parse_calibration(to_toml(calibration), "a.toml");
  REQUIRE(again.panel);
  CHECK(again.panel->quality == "kernel");
  CHECK(again.panel->touch->median_s == 0.0625);
  CHECK(again.panel->touch->sd_s == 0.004);
  CHECK(again.panel->touch->pairs == 40);
  CHECK(again.panel->touch->unmatched == 1);
  CHECK_FALSE(again.panel->flash);
}
