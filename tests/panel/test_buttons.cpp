#include <atomic>
#include <mutex>
#include <thread>

#include "station/drive/monotonic.hpp"
#include "station/panel/line_panel.hpp"
#include "station/panel/simulated_lines.hpp"
#include "station/panel/uri.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_lines.hpp"

using namespace turnpoint;
using namespace turnpoint::panel;
using Result = EdgeFilter::Result;

namespace {
constexpr std::int64_t ms = 1'000'000;
}

TEST_CASE("the first edge of a bouncing contact counts, with its own time", "[panel][buttons]") {
  EdgeFilter filter(50 * ms, false);
  CHECK(filter.edge(1000 * ms, true) == Result::pressed);
  for (int k = 1; k < 20; ++k) CHECK(filter.edge((1000 + k) * ms, k % 2 == 0) == Result::ignored);
  CHECK(filter.settle(1049 * ms, true) == Result::ignored);
  CHECK(filter.settle(1060 * ms, true) == Result::ignored);
  CHECK(filter.edge(1200 * ms, false) == Result::released);
  CHECK(filter.edge(1300 * ms, true) == Result::pressed);
}

TEST_CASE("a release hidden in the refractory time is found once the contact is quiet", "[panel][buttons]") {
  EdgeFilter filter(50 * ms, false);
  CHECK(filter.edge(1000 * ms, true) == Result::pressed);
  CHECK(filter.edge(1030 * ms, false) == Result::ignored);
  CHECK(filter.settle(1051 * ms, false) == Result::released);
  CHECK(filter.edge(1500 * ms, true) == Result::pressed);
}

TEST_CASE("a gap in the kernel's numbers tells how many edges were lost", "[panel][buttons]") {
  SequenceCheck check;
  CHECK(check.missed_before(1) == 0);
  CHECK(check.missed_before(2) == 0);
  CHECK(check.missed_before(7) == 4);
  CHECK(check.missed_before(8) == 0);
}

TEST_CASE("presses, contact, lost edges, and a chip lost and back reach the handlers with their times",
          "[panel][buttons][threads]") {
  std::mutex mutex;
  std::vector<Press> presses;
  std::vector<Touch> touches;
  std::vector<std::string> faults;
  std::vector<std::int64_t> returns;
  PanelHandlers handlers;
  handlers.press = [&](const Press& press) {
    const std::lock_guard lock(mutex);
    presses.push_back(press);
  };
  handlers.touch = [&](const Touch& touch) {
    const std::lock_guard lock(mutex);
    touches.push_back(touch);
  };
  handlers.fault = [&](const PanelFault& fault) {
    const std::lock_guard lock(mutex);
    faults.push_back(fault.what);
  };
  handlers.back = [&](std::int64_t time_ns) {
    const std::lock_guard lock(mutex);
    returns.push_back(time_ns);
  };
  const auto lines = std::make_shared<SimulatedLines>(3);
  LinePanel plan;
  plan.lines = 3;
  plan.contact = 2;
  const auto panel = watch_lines(opener(lines), plan, {"left", "right"}, handlers);
  const auto reached = [&](auto& list, std::size_t count) {
    const std::int64_t end = drive::monotonic_ns() + 5'000'000'000;
    while (drive::monotonic_ns() < end) {
      const std::lock_guard lock(mutex);
      if (list.size() >= count) return true;
    }
    return false;
  };
  const std::int64_t now = drive::monotonic_ns();
  lines->set(1, true, now);
  lines->set(1, false, now + 1 * ms);
  lines->set(1, true, now + 2 * ms);
  REQUIRE(reached(presses, 1));
  CHECK(presses[0].button == 1);
  CHECK(presses[0].time_ns == now);
  lines->set(2, true, now + 3 * ms);
  REQUIRE(reached(touches, 1));
  CHECK(touches[0].on);
  lines->set(0, true, now);
  lines->lose_edges(0, 5);
  lines->set(0, false, now + 100 * ms);
  REQUIRE(reached(faults, 1));
  CHECK(faults[0] == "5 edges of line 0 were lost");
  lines->remove();
  REQUIRE(reached(faults, 2));
  CHECK(faults[1].find("simulated gpio chip") == 0);
  CHECK(presses.size() == 2);
  CHECK(panel->missing() == "simulated gpio chip: No such device");
  lines->set(1, true, now + 200 * ms);  // held down while it comes back: not a press
  lines->put_back();
  REQUIRE(reached(returns, 1));
  CHECK(panel->missing().empty());
  const std::int64_t later = drive::monotonic_ns();
  lines->set(1, false, later);
  lines->set(1, true, later + 100 * ms);
  REQUIRE(reached(presses, 3));
  CHECK(presses[2].time_ns == later + 100 * ms);
  CHECK(faults.size() == 2);
  CHECK_THROWS_AS(panel->simulate(Press{}), std::logic_error);
}

TEST_CASE("a simulated panel hands on what is simulated, and mistakes in the text are named",
          "[panel][buttons]") {
  int pressed = -1;
  PanelHandlers handlers;
  handlers.press = [&](const Press& press) { pressed = press.button; };
  const auto panel = open_panel(ButtonsConfig{"sim:"}, ContactConfig{"sim:"}, handlers);
  panel->simulate(Press{1, 1});
  CHECK(pressed == 1);
  CHECK(panel->buttons().size() == 2);
  CHECK(panel->tells_position());
  const auto none = open_panel(std::nullopt, std::nullopt, handlers);
  CHECK(none->buttons().empty());
  CHECK_FALSE(none->has_contact());
  CHECK_THROWS_AS(open_panel(ButtonsConfig{"gpio:left=NO_SUCH_LINE"}, std::nullopt, handlers), LineError);
  CHECK_THROWS_AS(open_panel(ButtonsConfig{"gpio:left=A,refractory_ms=-1"}, std::nullopt, handlers),
                  std::invalid_argument);
  CHECK_THROWS_AS(open_panel(std::nullopt, ContactConfig{"evdev:none,axis=z"}, handlers),
                  std::invalid_argument);
  CHECK_THROWS_AS(open_panel(std::nullopt, ContactConfig{"evdev:No Such Device"}, handlers),
                  std::system_error);
}
