#include "station/core/usage_error.hpp"
#include "station/io/touch_reader.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/fake_evdev.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint::io;

namespace {

constexpr std::int64_t ms = 1'000'000;

TouchDecoder decoder() { return {{0, 799}, {0, 479}}; }

/// Waits up to ten seconds until the condition is true. The limit only ends a test that hangs.
template <typename Condition>
bool comes(Condition condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::yield();
  }
  return true;
}

/// Touches the panel on the left, at half the height.
void touch(FakeEvdev& panel, long time_us) {
  panel.send(time_us, EV_ABS, ABS_MT_SLOT, 0);
  panel.send(time_us, EV_ABS, ABS_MT_TRACKING_ID, 5);
  panel.send(time_us, EV_ABS, ABS_MT_POSITION_X, 80);
  panel.send(time_us, EV_ABS, ABS_MT_POSITION_Y, 240);
  panel.send(time_us, EV_SYN, SYN_REPORT, 0);
}

}  // namespace

TEST_CASE("a finger that comes down is one touch, at the time of its report", "[touch]") {
  auto panel = decoder();
  const auto touches = panel.report(1500 * ms, std::vector<Finger>{{7, 799, 0}});
  REQUIRE(touches.size() == 1);
  CHECK(touches[0].time_ns == 1500 * ms);
  CHECK(touches[0].x == 1);
  CHECK(touches[0].y == 0);
  CHECK(panel.report(1510 * ms, std::vector<Finger>{{7, 700, 0}}).empty());
  CHECK(panel.report(1520 * ms, std::vector<Finger>{{std::nullopt, 700, 0}}).empty());
}

TEST_CASE("two fingers in one report are two touches, each at its place", "[touch]") {
  auto panel = decoder();
  const auto touches = panel.report(10 * ms, std::vector<Finger>{{1, 100, 100}, {2, 600, 400}});
  REQUIRE(touches.size() == 2);
  CHECK(touches[0].x == Approx(100.0 / 799));
  CHECK(touches[1].x == Approx(600.0 / 799));
}

TEST_CASE("a finger that is lifted and put down within one report is a new touch", "[touch]") {
  auto panel = decoder();
  panel.report(10 * ms, std::vector<Finger>{{1, 100, 100}});
  const auto again = panel.report(90 * ms, std::vector<Finger>{{2, 100, 100}});
  REQUIRE(again.size() == 1);
  CHECK(again[0].time_ns == 90 * ms);
}

TEST_CASE("a touch from Qt gets the kernel's time of the touch at the same place", "[touch]") {
  TouchTimes times;
  times.add({100 * ms, 0.20, 0.80});
  times.add({130 * ms, 0.70, 0.80});
  CHECK(times.claim(0.705, 0.79, 160 * ms) == 130 * ms);
  CHECK(times.claim(0.205, 0.79, 165 * ms) == 100 * ms);
}

TEST_CASE("each touch from the kernel gives its time to only one touch from Qt", "[touch]") {
  TouchTimes times;
  times.add({100 * ms, 0.2, 0.8});
  REQUIRE(times.claim(0.2, 0.8, 120 * ms));
  CHECK_FALSE(times.claim(0.2, 0.8, 121 * ms));
}

TEST_CASE("a touch from Qt gets no time from a touch at another place, in the future or long ago",
          "[touch]") {
  TouchTimes times;
  times.add({1000 * ms, 0.2, 0.8});
  CHECK_FALSE(times.claim(0.3, 0.8, 1020 * ms));
  CHECK_FALSE(times.claim(0.2, 0.8, 999 * ms));
  CHECK_FALSE(times.claim(0.2, 0.8, 1500 * ms));
  CHECK(times.claim(0.2, 0.8, 1020 * ms));
}

TEST_CASE("if two touches from the kernel fit, a touch from Qt gets the time of neither", "[touch]") {
  TouchTimes times;
  times.add({100 * ms, 0.2, 0.8});
  times.add({180 * ms, 0.2, 0.8});
  CHECK_FALSE(times.claim(0.2, 0.8, 200 * ms));
  times.add({600 * ms, 0.2, 0.8});
  CHECK(times.claim(0.2, 0.8, 620 * ms) == 600 * ms);
}

TEST_CASE("opening a missing touch panel is an error that names the panel", "[touch]") {
  try {
    TouchReader reader("No such panel", [](TouchPanelState) {});
    FAIL("opened a panel that does not exist");
  } catch (const turnpoint::core::UsageError& error) {
    CHECK(std::string(error.what()).find("No such panel") != std::string::npos);
  }
  CHECK_THROWS_AS(TouchReader("/dev/input/event999", [](TouchPanelState) {}), std::system_error);
}

TEST_CASE("an unplugged touch panel is reported once, and is read again once it is back",
          "[touch][threads]") {
  const TemporaryFolder folder;
  const auto path = folder / "event-panel";
  auto panel = std::make_unique<FakeEvdev>(2, path);
  std::atomic<int> lost{0}, back{0};
  TouchReader reader(path, [&](TouchPanelState state) { ++(state == TouchPanelState::lost ? lost : back); });
  touch(*panel, 1'000'000);
  CHECK(comes([&] { return reader.claim(0.1, 0.5, 1020 * ms) == 1000 * ms; }));
  CHECK(lost == 0);
  panel->unplug();
  CHECK(comes([&] { return lost == 1; }));
  CHECK(back == 0);
  panel.reset();
  panel = std::make_unique<FakeEvdev>(2, path);
  CHECK(comes([&] { return back == 1; }));
  touch(*panel, 5'000'000);
  CHECK(comes([&] { return reader.claim(0.1, 0.5, 5020 * ms) == 5000 * ms; }));
  CHECK(lost == 1);
}
