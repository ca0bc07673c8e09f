#include <algorithm>

#include "station/audio/engine.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::audio {
namespace {

PlayReport rendered(const StreamConfig& config, Burst burst) {
  const auto stream = open_synchronous(config);
  const auto onset_frame = stream->schedule_soon(burst).start_frame;
  stream->advance(burst.length_frames);
  stream->finish();
  PlayReport report = report_of(*stream);
  report.onset_frame = onset_frame;
  report.largest_sample = stream->largest_sample();
  return report;
}

PlayReport played(const StreamConfig& config, Burst burst) {
  const auto stream = open_realtime(config);
  const auto scheduled = stream->schedule_soon(burst);
  for (bool sounding = true; sounding;) {
    system::sleep_until_ns(system::monotonic_ns() + 10'000'000);
    while (const auto event = stream->poll()) {
      const bool over = event->kind == EventKind::burst_ended || event->kind == EventKind::burst_missed;
      if ((over && event->burst == scheduled.burst) || event->kind == EventKind::device_lost)
        sounding = false;
    }
  }
  PlayReport report = report_of(*stream);
  report.onset_frame = scheduled.start_frame;
  return report;
}

}  // namespace

Scheduled Stream::schedule_soon(const Burst& burst) {
  const PreparedBurst prepared = prepare(burst, format_of(config().output), config().limits);
  return schedule_together({&prepared, 1}).front();
}

PlayReport report_of(Stream& stream) {
  PlayReport report;
  report.counters = stream.counters();
  report.rights = stream.rights();
  report.clock = stream.clock();
  report.rate = stream.measured_rate();
  return report;
}

PlayReport play(const StreamConfig& config, Burst burst) {
  burst.start_frame = 0;
  const PreparedBurst prepared = prepare(burst, format_of(config.output), config.limits);
  PlayReport report =
      config.output.uri.starts_with("alsa:") ? played(config, burst) : rendered(config, burst);
  report.peak = *std::max_element(prepared.peak.begin(), prepared.peak.end());
  return report;
}

}  // namespace turnpoint::audio
