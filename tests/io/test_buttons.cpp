#include <atomic>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "station/core/usage_error.hpp"
#include "station/io/simulated_lines.hpp"
#include "station/io/uri.hpp"
#include "station/io/watched_lines.hpp"
#include "station/system/clocks.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_lines.hpp"

using namespace turnpoint;
using namespace turnpoint::io;
using Kind = LineChange::Kind;

namespace {
constexpr std::int64_t us = 1'000, ms = 1'000'000;
}

// Returns what the filter reports for these edges, given as (time in us, level), when no further edge comes
// until `until_us`.
std::vector<LineChange> changes(EdgeFilter& filter, const std::vector<std::pair<std::int64_t, bool>>& edges,
                                std::int64_t until_us) {
  std::vector<LineChange> all;
  const auto decide = [&](std::int64_t time_ns) {
    while (const auto change = filter.decide(time_ns)) all.push_back(*change);
  };
  for (const auto& [time_us, level] : edges) {
    decide(time_us * us);
    if (const auto change = filter.edge(time_us * us, level)) all.push_back(*change);
  }
  decide(until_us * us);
  return all;
}

TEST_CASE("a level that lasts is a press, with the time stamp of its first edge", "[lines][buttons]") {
  EdgeFilter filter({}, false);
  CHECK(changes(filter, {{1000, true}}, 2499).empty());
  const auto told = changes(filter, {}, 2500);
  REQUIRE(told.size() == 1);
  CHECK(told[0].kind == Kind::pressed);
  CHECK(told[0].time_ns == 1000 * us);
}

TEST_CASE("a spike of 3 us is a glitch and not a press, however often it occurs", "[lines][buttons]") {
  EdgeFilter filter({}, false);
  std::vector<std::pair<std::int64_t, bool>> spikes;
  for (int k = 0; k < 100; ++k) {
    spikes.push_back({1000 + 5000 * k, true});
    spikes.push_back({1003 + 5000 * k, false});
  }
  const auto told = changes(filter, spikes, 1'000'000);
  REQUIRE(told.size() == 100);
  for (std::size_t k = 0; k < told.size(); ++k) {
    CHECK(told[k].kind == Kind::glitch);
    CHECK(told[k].time_ns == static_cast<std::int64_t>(1000 + 5000 * k) * us);
    CHECK(told[k].length_ns == 3 * us);
    CHECK(told[k].edges == 2);
  }
}

TEST_CASE("the rig determines how long a level must last to be a press", "[lines][buttons]") {
  EdgeFilter::Rules rules;
  rules.hold_ns = 4000 * us;
  EdgeFilter slow(rules, false), quick({}, false);
  const std::vector<std::pair<std::int64_t, bool>> two_ms{{1000, true}, {3000, false}};
  CHECK(changes(slow, two_ms, 90'000).at(0).kind == Kind::glitch);
  CHECK(changes(quick, two_ms, 90'000).at(0).kind == Kind::pressed);
}

TEST_CASE("a spike so short that its two edges both show the old level is a glitch", "[lines][buttons]") {
  EdgeFilter filter({}, false);
  const auto told = changes(filter, {{1000, false}, {1001, false}}, 9000);
  REQUIRE(told.size() == 1);
  CHECK(told[0].kind == Kind::glitch);
}

TEST_CASE("a bouncing contact is one press at its first edge", "[lines][buttons]") {
  EdgeFilter filter({}, false);
  std::vector<std::pair<std::int64_t, bool>> bouncing;
  for (int k = 0; k < 15; ++k) bouncing.push_back({1'000'000 + 400 * k, k % 2 == 0});
  const auto told = changes(filter, bouncing, 1'030'000);
  REQUIRE(told.size() == 1);
  CHECK(told[0].kind == Kind::pressed);
  CHECK(told[0].time_ns == 1'000'000 * us);
}

TEST_CASE("continuous interference is reported as glitches, and a press after it has its own time stamp",
          "[lines][buttons]") {
  EdgeFilter filter({}, false);
  std::vector<std::pair<std::int64_t, bool>> edges;
  for (int k = 0; k < 900; ++k) edges.push_back({1000 + 100 * k, k % 2 == 0});
  edges.push_back({200'000, true});
  const auto told = changes(filter, edges, 300'000);
  REQUIRE(told.size() >= 2);
  for (std::size_t k = 0; k + 1 < told.size(); ++k) CHECK(told[k].kind == Kind::glitch);
  CHECK(told.back().kind == Kind::pressed);
  CHECK(told.back().time_ns == 200'000 * us);
}

TEST_CASE("a press within the refractory time is reported after that time, with the kernel's time stamp",
          "[lines][buttons]") {
  EdgeFilter filter({}, true);
  const auto told = changes(filter, {{1'000'000, false}, {1'030'000, true}}, 1'049'999);
  REQUIRE(told.size() == 1);
  CHECK(told[0].kind == Kind::released);
  const auto later = changes(filter, {}, 1'050'000);
  REQUIRE(later.size() == 1);
  CHECK(later[0].kind == Kind::pressed);
  CHECK(later[0].time_ns == 1'030'000 * us);
}

TEST_CASE("a contact that opens again within the refractory time is taken to be bouncing",
          "[lines][buttons]") {
  EdgeFilter filter({}, false);
  const auto told = changes(filter, {{1'000'000, true}, {1'020'000, false}, {1'040'000, true}}, 1'200'000);
  REQUIRE(told.size() == 1);
  CHECK(told[0].time_ns == 1'000'000 * us);
}

TEST_CASE("a level that no edge explains is reported as lost edges and not as a press", "[lines][buttons]") {
  EdgeFilter filter({}, false);
  CHECK_FALSE(filter.level(1000 * us, true));  // the edge for this level may still arrive
  CHECK_FALSE(filter.level(1001 * us, false));
  CHECK_FALSE(filter.level(2000 * us, true));
  CHECK_FALSE(filter.level(3499 * us, true));
  const auto lost = filter.level(3500 * us, true);
  REQUIRE(lost);
  CHECK(lost->kind == Kind::lost);
  CHECK(lost->active);
  CHECK(changes(filter, {}, 1'000'000).empty());
  const auto told = changes(filter, {{1'000'000, false}, {2'000'000, true}}, 3'000'000);
  REQUIRE(told.size() == 2);
  CHECK(told[1].kind == Kind::pressed);
}

TEST_CASE("an edge that arrives after the level was read is a press with its own time stamp",
          "[lines][buttons]") {
  EdgeFilter filter({}, false);
  CHECK_FALSE(filter.level(1000 * us, true));
  const auto told = changes(filter, {{999, true}}, 3000);
  REQUIRE(told.size() == 1);
  CHECK(told[0].kind == Kind::pressed);
  CHECK(told[0].time_ns == 999 * us);
  CHECK_FALSE(filter.level(9000 * us, true));
}

TEST_CASE("a gap in the kernel's sequence numbers shows how many edges were lost", "[lines][buttons]") {
  SequenceCheck check;
  CHECK(check.missed_before(1) == 0);
  CHECK(check.missed_before(2) == 0);
  CHECK(check.missed_before(7) == 4);
  CHECK(check.missed_before(8) == 0);
}

TEST_CASE(
    "the handlers get presses, contacts, lost edges, and the loss and return of the chip, all with their "
    "times",
    "[lines][buttons][threads]") {
  std::mutex mutex;
  std::vector<Press> presses;
  std::vector<io::Contact> touches;
  std::vector<std::string> faults;
  std::vector<Glitch> glitches;
  std::vector<std::int64_t> returns;
  ButtonsHandlers handlers;
  handlers.press = [&](const Press& press) {
    const std::lock_guard lock(mutex);
    presses.push_back(press);
  };
  handlers.contact = [&](const io::Contact& touch) {
    const std::lock_guard lock(mutex);
    touches.push_back(touch);
  };
  handlers.glitch = [&](const Glitch& glitch) {
    const std::lock_guard lock(mutex);
    glitches.push_back(glitch);
  };
  handlers.fault = [&](const ButtonsFault& fault) {
    const std::lock_guard lock(mutex);
    faults.push_back(fault.what);
  };
  handlers.back = [&](std::int64_t time_ns) {
    const std::lock_guard lock(mutex);
    returns.push_back(time_ns);
  };
  const auto lines = std::make_shared<SimulatedLines>(3);
  WatchedLines plan;
  plan.lines = 3;
  plan.contact = 2;
  plan.names = {"left", "right", "contact"};
  const auto panel = watch_lines(opener(lines), plan, handlers);
  CHECK(panel->names() == std::vector<std::string>{"left", "right"});
  const auto reached = [&](auto& list, std::size_t count) {
    const std::int64_t end = system::monotonic_ns() + 5'000'000'000;
    while (system::monotonic_ns() < end) {
      const std::lock_guard lock(mutex);
      if (list.size() >= count) return true;
    }
    return false;
  };
  const std::int64_t now = system::monotonic_ns();
  // The second and third pulse come less than a second after the first, so they are only counted.
  for (const std::int64_t ago : {2000, 1980, 1960, 10}) lines->pulse(0, now - ago * ms, 3 * us);
  REQUIRE(reached(glitches, 2));
  CHECK(glitches[0].line == "left");
  CHECK(glitches[0].length_ns == 3 * us);
  CHECK(glitches[0].untold == 0);
  CHECK(glitches[1].time_ns == now - 10 * ms);
  CHECK(glitches[1].untold == 2);
  CHECK(presses.empty());
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
  CHECK(faults[0] == "line left: 5 edges of the line were lost");
  lines->remove();
  REQUIRE(reached(faults, 2));
  CHECK(faults[1].find("simulated gpio chip") == 0);
  CHECK(presses.size() == 2);
  CHECK(panel->missing() == "simulated gpio chip: No such device");
  lines->set(1, true, now + 200 * ms);  // a button held down while the chip returns is not a press
  lines->put_back();
  REQUIRE(reached(returns, 1));
  CHECK(panel->missing().empty());
  const std::int64_t later = system::monotonic_ns();
  lines->set(1, false, later);
  lines->set(1, true, later + 100 * ms);
  REQUIRE(reached(presses, 3));
  CHECK(presses[2].time_ns == later + 100 * ms);
  CHECK(faults.size() == 2);
  CHECK_THROWS_AS(panel->simulate(Press{}), std::logic_error);
}

TEST_CASE("a simulated button panel passes on simulated presses, and mistakes in its text are named",
          "[lines][buttons]") {
  int pressed = -1;
  ButtonsHandlers handlers;
  handlers.press = [&](const Press& press) { pressed = press.button; };
  const auto panel = open_buttons(ButtonsConfig{"sim:"}, ContactConfig{"sim:"}, handlers);
  panel->simulate(Press{1, 1});
  CHECK(pressed == 1);
  CHECK(panel->names().size() == 2);
  const auto none = open_buttons(std::nullopt, std::nullopt, handlers);
  CHECK(none->names().empty());
  CHECK_THROWS_AS(open_buttons(ButtonsConfig{"gpio:left=NO_SUCH_LINE"}, std::nullopt, handlers), LineError);
  CHECK_THROWS_AS(open_buttons(ButtonsConfig{"gpio:left=A,refractory_ms=-1"}, std::nullopt, handlers),
                  core::UsageError);
  CHECK_THROWS_AS(open_buttons(ButtonsConfig{"gpio:left=A,hold_ms=11"}, std::nullopt, handlers),
                  core::UsageError);
  CHECK_THROWS_AS(open_buttons(std::nullopt, ContactConfig{"evdev:none,axis=z"}, handlers), core::UsageError);
  CHECK_THROWS_AS(open_buttons(std::nullopt, ContactConfig{"evdev:No Such Device"}, handlers),
                  std::system_error);
}

TEST_CASE("hold_ms in the rig file decides how long a button must be down to count as pressed",
          "[lines][buttons][threads]") {
  for (const auto& [hold, is_press] : {std::pair{"hold_ms=1", true}, std::pair{"hold_ms=4", false}}) {
    INFO(hold);
    const auto lines = std::make_shared<SimulatedLines>(2);
    std::atomic<int> presses{0}, glitches{0};
    ButtonsHandlers handlers;
    handlers.press = [&](const Press& press) { presses += press.button == 1 ? 1 : 0; };
    handlers.glitch = [&](const Glitch& glitch) { glitches += glitch.line == "right" ? 1 : 0; };
    const auto panel = open_buttons(ButtonsConfig{std::string("gpio:left=A,right=B,") + hold}, std::nullopt,
                                    handlers, [&](const std::vector<LineRequest>& requests) {
                                      REQUIRE(requests.size() == 2);
                                      return std::make_unique<SharedLines>(lines);
                                    });
    lines->pulse(1, system::monotonic_ns(), 2 * ms);
    const auto until_ns = system::monotonic_ns() + 10'000 * ms;
    while (presses + glitches == 0 && system::monotonic_ns() < until_ns) std::this_thread::yield();
    CHECK(presses == (is_press ? 1 : 0));
    CHECK(glitches == (is_press ? 0 : 1));
  }
}
