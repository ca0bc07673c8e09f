#include "station/audio/engine.hpp"
#include "station/system/clocks.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;
using namespace turnpoint::system;

TEST_CASE(
    "a real-time stream to the null device plays bursts at their frames and reports its real-time rights",
    "[drive][realtime][threads]") {
  StreamConfig config;
  const auto stream = open_realtime(config);
  CHECK(stream->rights().asked);
  if (stream->rights().fifo_priority == 0 || !stream->rights().memory_locked)
    CHECK_FALSE(stream->rights().note.empty());
  std::vector<std::int64_t> asked, started, ended;
  for (int k = 0; k < 3; ++k) {
    Burst burst = one_tone(20000, 0.3);
    burst.start_frame = stream->earliest_frame() + 2000;
    burst.length_frames = 3000;
    burst.ramp.frames = 1000;
    asked.push_back(burst.start_frame);
    stream->schedule(burst);
    while (ended.size() <= static_cast<std::size_t>(k)) {
      sleep_until_ns(monotonic_ns() + 1'000'000);
      while (const auto event = stream->poll()) {
        if (event->kind == EventKind::burst_started) started.push_back(event->frame);
        if (event->kind == EventKind::burst_ended) ended.push_back(event->frame - 3000);
      }
    }
  }
  CHECK(started == asked);
  CHECK(ended == asked);
  const ClockFit fit = stream->clock();
  CHECK(fit.pairs > 8);
  CHECK(fit.rate_Hz() == Approx(192000).epsilon(1e-6));
  CHECK(stream->frame_at(stream->time_of(asked[0]).value()) == asked[0]);
}

TEST_CASE("a burst whose check takes longer than the buffer lasts begins later, and is not missed",
          "[drive][realtime][threads]") {
  // The amplitudes add up to more than full scale. Only by rendering all 10 s can the stream find that the
  // peak stays below full scale.
  Burst burst = one_tone(20000, 0.07);
  burst.tones.count = 16;
  for (int k = 1; k < 16; ++k)
    burst.tones.tones[static_cast<std::size_t>(k)] = {20000 + 1234.5 * k, 0.07, 0.7 * k * k, 0};
  burst.length_frames = 1920000;
  const auto stream = open_realtime({});
  burst.start_frame = stream->earliest_frame();
  // the check takes so long that the start frame is already past
  CHECK_THROWS_AS(stream->schedule(burst), BurstRefused);
  const auto scheduled = stream->schedule_soon(burst);
  CHECK(scheduled.start_frame > burst.start_frame);
  std::optional<Event> first;
  while (!first) {
    sleep_until_ns(monotonic_ns() + 1'000'000);
    first = stream->poll();
  }
  CHECK(first->kind == EventKind::burst_started);
  CHECK(first->burst == scheduled.burst);
  CHECK(first->frame == scheduled.start_frame);
  CHECK(stream->counters().missed == 0);
}
