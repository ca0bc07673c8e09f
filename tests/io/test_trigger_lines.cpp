#include "station/io/trigger_lines.hpp"

#include <algorithm>
#include <mutex>
#include <thread>

#include "station/core/usage_error.hpp"
#include "station/io/simulated_lines.hpp"
#include "station/io/sync_line.hpp"
#include "station/system/clocks.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_lines.hpp"

using namespace turnpoint;
using namespace turnpoint::io;

namespace {

constexpr std::int64_t ms = 1'000'000;

struct Set {
  std::int64_t time_ns = 0;
  std::uint32_t levels = 0;
};

/// The levels to which the lines were set, with the times.
struct Record {
  std::mutex mutex;
  std::vector<Set> sets;
  std::vector<std::uint32_t> levels() {
    const std::lock_guard lock(mutex);
    std::vector<std::uint32_t> all;
    for (const auto& set : sets) all.push_back(set.levels);
    return all;
  }
};

class RecordedOutputs final : public Outputs {
 public:
  explicit RecordedOutputs(Record& record) : record_(record) {}
  void drive(std::uint32_t levels) override {
    const std::lock_guard lock(record_.mutex);
    if (levels == 99) throw std::system_error(ENODEV, std::generic_category(), "gone");
    record_.sets.push_back({system::monotonic_ns(), levels});
  }

 private:
  Record& record_;
};

TriggerPlan three_bits(bool strobe) {
  TriggerPlan plan;
  plan.bits = 3, plan.strobe = strobe, plan.pulse_ns = 2 * ms;
  return plan;
}

std::vector<TriggerLines::Given> given(TriggerLines& lines, std::size_t count) {
  std::vector<TriggerLines::Given> all;
  for (int k = 0; k < 2000 && all.size() < count; ++k) {
    for (const auto& one : lines.take()) all.push_back(one);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return all;
}

}  // namespace

TEST_CASE("a code stays on the lines for the length of its pulse, and the strobe lies inside this time",
          "[lines][trigger]") {
  const bool strobe = GENERATE(false, true);
  Record record;
  const auto due_ns = system::monotonic_ns() + 5 * ms;
  {
    TriggerLines lines(std::make_unique<RecordedOutputs>(record), three_bits(strobe));
    lines.give(5, due_ns);
    lines.give(2, due_ns + ms);
    const auto all = given(lines, 2);
    REQUIRE(all.size() == 2);
    CHECK(all[0].code == 5);
    CHECK(all[0].due_ns == due_ns);
    CHECK(all[0].time_ns >= due_ns);
    CHECK(all[1].time_ns >= all[0].time_ns + 3 * ms);
    for (int k = 0; k < 1000 && record.levels().back() != 0; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (strobe)
    CHECK(record.levels() == std::vector<std::uint32_t>{5, 13, 5, 0, 2, 10, 2, 0});
  else
    CHECK(record.levels() == std::vector<std::uint32_t>{5, 0, 2, 0});
  CHECK(record.sets[strobe ? 3 : 1].time_ns - record.sets[0].time_ns >= 2 * ms);
}

TEST_CASE("a code that is due earlier comes first, and cancelled codes never come", "[lines][trigger]") {
  Record record;
  const auto now_ns = system::monotonic_ns();
  TriggerLines lines(std::make_unique<RecordedOutputs>(record), three_bits(false));
  lines.give(1, now_ns + 60 * ms);
  lines.give(2, now_ns + 30 * ms);
  lines.give(3, now_ns + 3600'000 * ms);
  lines.cancel(now_ns + 1000 * ms);
  lines.give(4, now_ns - ms);
  const auto all = given(lines, 3);
  REQUIRE(all.size() == 3);
  CHECK(all[0].code == 4);
  CHECK(all[1].code == 2);
  CHECK(all[2].code == 1);
  CHECK(lines.failure() == "");
}

TEST_CASE("if lines cannot be set, the failure is reported with its reason", "[lines][trigger]") {
  Record record;
  auto plan = three_bits(false);
  plan.bits = 8;
  TriggerLines lines(std::make_unique<RecordedOutputs>(record), plan);
  lines.give(99, 0);
  for (int k = 0; k < 2000 && lines.failure().empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(lines.failure().find("gone") == 0);
  CHECK(lines.take().empty());
}

TEST_CASE("the lines for codes are named in order, beginning with the lowest bit", "[lines][trigger]") {
  const auto plan = trigger_plan("gpio:bit1=B,bit0=A,strobe=S,pulse_ms=2.5");
  CHECK(plan.names == std::vector<std::string>{"A", "B", "S"});
  CHECK(plan.bits == 2);
  CHECK(plan.strobe);
  CHECK(plan.pulse_ns == 2'500'000);
  CHECK(trigger_plan("sim:").bits == 8);
  CHECK_THROWS_AS(trigger_plan("gpio:bit1=B"), core::UsageError);
  CHECK_THROWS_AS(trigger_plan("gpio:bit0=A,bit2=B"), core::UsageError);
  CHECK_THROWS_AS(trigger_plan("gpio:bit0=A,pulse_ms=0.5x"), core::UsageError);
  CHECK_THROWS_AS(trigger_plan("usb:bit0=A"), core::UsageError);
}

TEST_CASE("each pulse of a sync line is reported with the time of its first edge", "[lines][trigger]") {
  const bool low = GENERATE(false, true);
  const auto lines = std::make_shared<SimulatedLines>(1);
  std::mutex mutex;
  std::vector<std::int64_t> pulses;
  std::vector<std::string> faults;
  ButtonsHandlers handlers;
  handlers.fault = [&](const ButtonsFault& fault) {
    const std::lock_guard lock(mutex);
    faults.push_back(fault.what);
  };
  const auto count = [&](auto& list) {
    const std::lock_guard lock(mutex);
    return list.size();
  };
  if (low) lines->set(0, true, 1);
  const SyncLine sync(
      opener(lines), low,
      [&](std::int64_t time_ns) {
        const std::lock_guard lock(mutex);
        pulses.push_back(time_ns);
      },
      handlers);
  for (const std::int64_t at : {100, 200, 300}) {
    lines->set(0, !low, at * ms);
    lines->set(0, low, at * ms + 10'000);
  }
  lines->lose_edges(0, 2);
  lines->set(0, !low, 400 * ms);
  for (int k = 0; k < 2000 && count(pulses) < 4; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(pulses == std::vector<std::int64_t>{100 * ms, 200 * ms, 300 * ms, 400 * ms});
  REQUIRE(faults.size() == 1);
  CHECK(faults[0] == "sync line: 2 edges were lost");
}

// Not a test: prints how late an ordinary thread on this machine sends codes. It runs only if it is called by
// name.
TEST_CASE("how late codes are", "[.][trigger]") {
  Record record;
  TriggerLines lines(std::make_unique<RecordedOutputs>(record), three_bits(true));
  const auto start_ns = system::monotonic_ns() + 100 * ms;
  constexpr int codes = 1000;
  for (int k = 0; k < codes; ++k) lines.give(1 + k % 7, start_ns + k * 20 * ms);
  std::vector<std::int64_t> late;
  while (late.size() < codes) {
    for (const auto& one : lines.take()) late.push_back(one.time_ns - one.due_ns);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::sort(late.begin(), late.end());
  WARN("us: median " << late[codes / 2] / 1000 << ", 99 % " << late[codes * 99 / 100] / 1000 << ", largest "
                     << late.back() / 1000);
}
