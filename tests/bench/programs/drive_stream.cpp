// drive_stream URI PERIOD_FRAMES SECONDS: plays a real-time stream with two bursts of 100 ms per second.
// Prints each event with its CLOCK_MONOTONIC time in ns. At the end, it prints the counters, the fitted
// clock, and the priority and memory lock that the audio thread received.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "station/audio/engine.hpp"
#include "station/system/clocks.hpp"

using namespace turnpoint::audio;
using namespace turnpoint::system;

namespace {

const char* name(EventKind kind) {
  switch (kind) {
    case EventKind::burst_started:
      return "started";
    case EventKind::burst_ended:
      return "ended";
    case EventKind::burst_heard:
      return "heard";
    case EventKind::burst_missed:
      return "missed";
    case EventKind::burst_unfollowed:
      return "unfollowed";
    case EventKind::burst_follows:
      return "follows";
    case EventKind::underrun:
      return "underrun";
    case EventKind::device_lost:
      return "lost";
    case EventKind::device_back:
      return "back";
    case EventKind::rate_wrong:
      return "rate_wrong";
  }
  return "?";
}

void run(const StreamConfig& config, double seconds) {
  const auto stream = open_realtime(config);
  std::printf("ready\n");
  Burst burst;
  burst.length_frames = config.output.rate_Hz / 10;
  burst.ramp.frames = config.output.rate_Hz / 50;
  burst.tones.count = 1;
  burst.tones.tones[0] = {30000, 0.5, 0, 0};
  const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  for (std::int64_t next_ns = monotonic_ns(); next_ns < end_ns;
       next_ns = std::max(next_ns + 500'000'000, monotonic_ns())) {
    burst.start_frame = stream->earliest_frame() + config.output.rate_Hz / 20;
    stream->schedule(burst);
    std::printf("%lld scheduled %lld predicted %lld\n", static_cast<long long>(monotonic_ns()),
                static_cast<long long>(burst.start_frame),
                static_cast<long long>(stream->time_of(burst.start_frame).value_or(0)));
    while (monotonic_ns() < next_ns + 500'000'000) {
      sleep_until_ns(monotonic_ns() + 5'000'000);
      while (const auto event = stream->poll())
        std::printf("%lld %s frame %lld frames %lld error %d\n", static_cast<long long>(monotonic_ns()),
                    name(event->kind), static_cast<long long>(event->frame),
                    static_cast<long long>(event->frames), event->error);
      std::fflush(stdout);
    }
  }
  const Counters counters = stream->counters();
  const ClockFit fit = stream->clock();
  const Rights rights = stream->rights();
  std::printf("counters bursts %lld missed %lld underruns %lld lost_frames %lld losses %lld saturated %lld\n",
              static_cast<long long>(counters.bursts), static_cast<long long>(counters.missed),
              static_cast<long long>(counters.underruns), static_cast<long long>(counters.lost_frames),
              static_cast<long long>(counters.device_losses), static_cast<long long>(counters.saturated));
  std::printf("clock rate_Hz %.3f residual_us %.3f pairs %d\n", fit.rate_Hz(), fit.residual_ns * 1e-3,
              fit.pairs);
  if (const auto rate = stream->measured_rate())
    std::printf("measured deviation_ppm %.2f standard_error_ppm %.2f\n", rate->deviation_ppm,
                rate->standard_error_ppm);
  std::printf("rights fifo %d locked %d %s\n", rights.fifo_priority, rights.memory_locked ? 1 : 0,
              rights.note.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "drive_stream URI PERIOD_FRAMES SECONDS\n"), 2;
  try {
    StreamConfig config;
    config.output.uri = argv[1];
    config.output.period_frames = std::atoi(argv[2]);
    config.output.periods = 32;  // a long buffer, so that short pauses of the host cause no underrun
    run(config, std::atof(argv[3]));
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
