// In these tests, a thread that calls the amplifier is held up before, inside or after the call, as if it had
// lost the processor. Meanwhile a fault or a stop becomes active; its edge may be lost. The guard must still
// take the enable line low, and the line must stay low when the thread continues.
#include <atomic>
#include <cstdlib>
#include <functional>
#include <random>
#include <semaphore>
#include <thread>

#include "station/io/guarded_amplifier.hpp"
#include "station/io/simulated_lines.hpp"
#include "station/system/clocks.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/number_from.hpp"
#include "tests/support/shared_lines.hpp"

using namespace turnpoint;
using namespace turnpoint::io;

namespace {

constexpr std::int64_t ms = 1'000'000;

/// A thread that makes one call at a time. The test can hold it at any point of the call.
class Caller {
 public:
  Caller() {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      for (begin_.acquire(); !stop.stop_requested(); begin_.acquire()) {
        points_ = 0;
        point();  // point 0 is before the call
        call_();
        while (points_ <= hold_at_) point();  // further points are after the call
        finished_.release();
      }
    });
  }
  ~Caller() {
    thread_.request_stop();
    begin_.release();
  }

  /// Begins the call, and returns once the thread is held at point number `hold_at`.
  void begin(std::function<void()> call, int hold_at) {
    call_ = std::move(call), hold_at_ = hold_at;
    begin_.release();
    held_.acquire();
  }
  void finish() {
    go_on_.release();
    finished_.acquire();
  }

  /// Marks a point at which the thread can be held. The simulated lines and the commands call it; for other
  /// threads it does nothing.
  void point() {
    if (std::this_thread::get_id() != thread_.get_id() || points_++ != hold_at_) return;
    held_.release();
    go_on_.acquire();
  }

 private:
  std::function<void()> call_;
  int hold_at_ = 0, points_ = 0;
  std::binary_semaphore begin_{0}, held_{0}, go_on_{0}, finished_{0};
  std::jthread thread_;
};

/// GPIO lines that can hold up the calling thread and lose edges. They count the edges that the guard has
/// handled.
struct WatchedLines : SharedLines {
  WatchedLines(const std::shared_ptr<SimulatedLines>& shared, Caller& caller_, std::atomic<int>& edges_done_,
               std::atomic<int>& beats_, std::atomic<bool>& loses_edges_)
      : SharedLines(shared), caller(caller_), edges_done(edges_done_), beats(beats_), loses(loses_edges_) {}

  std::optional<Edge> wait(std::int64_t timeout_ns, int wake) override {
    edges_done = edges_seen;  // the guard asks for the next edge, so it has handled all earlier ones
    auto edge = SharedLines::wait(timeout_ns, wake);
    if (!edge) return edge;
    ++edges_seen;
    return loses ? std::nullopt : edge;
  }
  bool level(int index) override {
    caller.point();
    return SharedLines::level(index);
  }
  void drive(int index, int level) override {
    caller.point();
    SharedLines::drive(index, level);
    caller.point();
    if (index == heartbeat) ++beats;
  }

  Caller& caller;
  std::atomic<int>&edges_done, &beats;
  std::atomic<bool>& loses;
  int edges_seen = 0;
};

struct Bench {
  Caller caller;
  std::shared_ptr<SimulatedLines> lines = std::make_shared<SimulatedLines>(SharedLines::count);
  std::atomic<int> edges_done{0}, beats{0};
  std::atomic<bool> loses_edges{false};
  int edges = 0;
  std::unique_ptr<audio::Amplifier> amplifier = open();

  std::unique_ptr<audio::Amplifier> open() {
    GuardOptions options;
    options.config.toggle_ns = ms / 5;
    options.config.audio_timeout_ns = options.config.session_timeout_ns = 3'600'000 * ms;
    options.scheduler_point = [this] { caller.point(); };
    return guard_amplifier(
        [this] { return std::make_unique<WatchedLines>(lines, caller, edges_done, beats, loses_edges); },
        {SharedLines::enable, SharedLines::heartbeat, SharedLines::fault, SharedLines::stop}, options);
  }

  bool high() { return lines->level(SharedLines::enable); }

  /// Waits until the guard has handled all edges so far. If edges are lost, waits until the guard has read
  /// the levels in two heartbeats. Gives up after five seconds, so that the test ends.
  bool settled() {
    const auto end_ns = system::monotonic_ns() + 5000 * ms;
    const int beats_before = beats;
    while (edges_done < edges || (loses_edges && beats < beats_before + 2)) {
      if (system::monotonic_ns() > end_ns) return false;
      std::this_thread::yield();
    }
    return true;
  }

  bool set(int line, bool active) {
    ++edges;
    lines->set(line, active, system::monotonic_ns());
    return settled();
  }

  void enable() {
    amplifier->audio_alive();
    amplifier->session_alive();
    REQUIRE_FALSE(amplifier->clear());
    REQUIRE_FALSE(amplifier->arm());
    REQUIRE_FALSE(amplifier->enable());
  }
};

int rounds() { return number_from("TURNPOINT_STALLS", 20'000); }

}  // namespace

TEST_CASE("the enable line is never high during a fault or stop, wherever a calling thread is held up",
          "[lines][amplifier][threads]") {
  Bench bench;
  auto& amplifier = *bench.amplifier;
  const std::function<void()> calls[] = {
      [&] { static_cast<void>(amplifier.arm()); },
      [&] { static_cast<void>(amplifier.enable()); },
      [&] { static_cast<void>(amplifier.clear()); },
      [&] { amplifier.disable(); },
      [&] { amplifier.disarm(); },
      [&] { amplifier.trip(core::FaultKind::suspended, "test"); },
      [&] { static_cast<void>(amplifier.state()); },
      [&] { static_cast<void>(amplifier.fault()); },
  };
  std::mt19937 random(17);
  const auto draw = [&random](int count) {
    return static_cast<int>(random() % static_cast<unsigned>(count));
  };
  int violations = 0, high_when_held = 0;
  for (int round = 0; round < rounds() && violations < 3; ++round) {
    bench.loses_edges = draw(4) == 0;
    bench.enable();
    if (draw(2) == 0) amplifier.disable();  // so that the next call of enable() changes the line
    bench.caller.begin(calls[draw(8)], draw(6));
    high_when_held += bench.high() ? 1 : 0;
    const int line = draw(2) == 0 ? SharedLines::fault : SharedLines::stop;
    const bool in_time = bench.set(line, true);
    violations += !in_time || bench.high() ? 1 : 0;
    bench.caller.finish();
    violations += bench.high() ? 1 : 0;
    bench.set(line, false);
    violations += bench.high() ? 1 : 0;  // the fault is latched, so the line must stay low
  }
  CHECK(violations == 0);
  CHECK(high_when_held > rounds() / 4);  // negative control: the line was often high during a held call
}

TEST_CASE("a call that switches the amplifier off takes effect even if its thread is held up inside the call",
          "[lines][amplifier][threads]") {
  for (int way = 0; way < 3; ++way)
    for (int hold_at = 1; hold_at < 4; ++hold_at) {
      Bench bench;
      bench.enable();
      bench.caller.begin(
          [&] {
            if (way == 0) bench.amplifier->disable();
            if (way == 1) bench.amplifier->disarm();
            if (way == 2) bench.amplifier->trip(core::FaultKind::suspended, "");
          },
          hold_at);
      const int before = bench.beats;
      while (bench.beats < before + 2) std::this_thread::yield();
      CHECK_FALSE(bench.high());
      bench.caller.finish();
    }
}
