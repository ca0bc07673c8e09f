#include <atomic>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "station/session/follow_loop.hpp"
#include "station/system/clocks.hpp"
#include "tests/follow/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

/// Locked memory of this process, in kB.
int locked_kB() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmLck:", 0) == 0) return std::stoi(line.substr(6));
  return -1;
}

sensing::FingerSetup cells_of_a_rig() {
  sensing::FingerSetup cells;
  cells.calibration = sensing::ForceCalibration({{{12, 0, 0}, {12, 0, 3600}, {0, 12, 0}}}, {});
  return cells;
}

audio::Burst burst_that_follows() {
  audio::Burst burst;
  burst.length_frames = 9600;
  burst.ramp.frames = 960;
  burst.tones.count = 1;
  burst.tones.tones[0] = {30000, 0.5, 0, 0};
  burst.following = {1, 0, 960, 960, 1920};
  return burst;
}

}  // namespace

TEST_CASE("the memory of the loop and of its trials is locked, if that of its stream is",
          "[session][follow][realtime]") {
  // The heap of the first thread is locked with the program. Memory of other threads, such as the session's,
  // is not.
  std::thread([] {
    audio::StreamConfig config;
    config.output.period_frames = 96;
    config.output.periods = 2;
    const auto stream = audio::open_realtime(config);
    if (!stream->rights().memory_locked) {
      WARN("skipped: memory cannot be locked here, " << stream->rights().note << "; sudo tests/run");
      return;
    }
    // what the heap has grown since is locked too, so that it does not count below
    static_cast<void>(system::lock_memory({}));
    const int before_kB = locked_kB();
    auto loop = std::make_unique<session::FollowLoop>(*stream, 4);
    const int with_ring_kB = locked_kB();
    CAPTURE(before_kB, with_ring_kB);
    CHECK(with_ring_kB - before_kB > 400);
    CHECK(loop->not_locked().empty());
    const auto plan = std::make_shared<const follow::Plan>(lab::plan_of({}));
    const auto prepared = audio::prepare(burst_that_follows(), {192000, 2, 24});
    static_cast<void>(system::lock_memory({}));
    const int before_trial_kB = locked_kB();
    loop->prepare({plan}, {&prepared, 1}, cells_of_a_rig());
    const int with_trial_kB = locked_kB();
    CAPTURE(before_trial_kB, with_trial_kB);
    CHECK(with_trial_kB - before_trial_kB > 100);
  }).join();
}

TEST_CASE("session, capture and audio threads work on the loop at the same time",
          "[session][follow][threads]") {
  audio::StreamConfig config;
  config.output.period_frames = 96;
  config.output.periods = 2;
  const auto stream = audio::open_realtime(config);
  session::FollowLoop loop(*stream, 4);
  std::atomic<bool> over = false;
  std::thread capture([&] {
    std::vector<std::int32_t> frames(4 * 96);
    for (std::int64_t first = 0; !over; first += 96) {
      for (std::size_t k = 0; k < frames.size(); ++k)
        frames[k] = static_cast<std::int32_t>((first + std::int64_t(k)) * 7919 % 100003);
      loop.captured(first, first > 20000 && first % 960 == 0 ? 1 : 0, frames);
      if (first % 9600 == 0) system::sleep_until_ns(system::monotonic_ns() + 1'000'000);
    }
  });
  const auto plan = std::make_shared<const follow::Plan>(lab::plan_of({}));
  const auto cells = cells_of_a_rig();
  std::size_t happened = 0;
  int compared = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const auto burst = burst_that_follows();
    const auto prepared = audio::prepare(burst, {192000, 2, 24});
    loop.prepare({plan}, {&prepared, 1}, cells);
    compared += loop.check_delay({0, 0}) || loop.check_delay({0, 1}) ? 1 : 0;
    const auto scheduled = stream->schedule_soon(burst);
    // frames of the capture and of the playback are not related here, so the interval is long enough for any
    const std::vector<session::FollowLoop::Burst> bursts{{scheduled.burst, 0, std::int64_t{1} << 40}};
    loop.begin(bursts, sensing::Readings{}, {0, 0});
    for (bool ended = false; !ended;) {
      system::sleep_until_ns(system::monotonic_ns() + 2'000'000);
      while (const auto event = stream->poll()) {
        loop.note(*event);
        ended |=
            event->kind == audio::EventKind::burst_ended || event->kind == audio::EventKind::burst_missed;
      }
      loop.gather();
    }
    const auto followed = loop.take();
    happened += followed.periods.size() + followed.late.size();
  }
  over = true;
  capture.join();
  CHECK(compared > 0);
  CHECK(happened >= 20);  // at least one period or one late gain in nearly every trial
}
