#include "station/maintenance/play_armed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "station/audio/prepared_burst.hpp"
#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/io/amplifier.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"
#include "station/session/burst.hpp"
#include "station/session/stage.hpp"
#include "station/system/clocks.hpp"
#include "station/system/stop_signals.hpp"

namespace turnpoint::maintenance {

using core::Failure, core::phrase, core::plain;

namespace {

constexpr double kLead_s = 0.5, kMargin_s = 0.5;
// longest time to wait, after the calculated end, until the device has played all tones
constexpr std::int64_t kHeard_ns = 2'000'000'000;
constexpr std::int64_t kPoll_ns = 5'000'000;
// time to wait until the audio thread has sent its first report
constexpr std::int64_t kFirstBlocks_ns = 200'000'000;

/// Returns the reason why the tones were not played correctly; nothing for normal events.
core::Phrase trouble_of(const audio::Event& event, const audio::OutputConfig& output) {
  switch (event.kind) {
    case audio::EventKind::underrun:
      return phrase("played.lost", {plain(output.uri), plain(event.frames)});
    case audio::EventKind::device_lost:
      return phrase("played.disconnected", {plain(output.uri)});
    case audio::EventKind::burst_missed:
      return phrase("played.too_late", {plain(output.uri)});
    case audio::EventKind::rate_wrong:
      return phrase("played.rate",
                    {plain(output.uri), plain(core::number(1e-3 * static_cast<double>(event.frames), 7)),
                     plain(output.rate_Hz)});
    case audio::EventKind::burst_started:
    case audio::EventKind::burst_ended:
    case audio::EventKind::burst_unfollowed:
    case audio::EventKind::burst_follows:
    case audio::EventKind::burst_heard:
    case audio::EventKind::device_back:
      return {};
  }
  return {};
}

/// Until `done` returns true, reads the stream's events and keeps reporting to the amplifier that this
/// program is running. Returns at once if a stop is requested. Throws if a tone was not played correctly, or
/// after a termination signal.
void attend(audio::Stream& stream, audio::Amplifier& amplifier, const std::stop_token& stop,
            const std::function<bool()>& done) {
  for (;;) {
    const bool last = done();  // call done() before polling, so that all events up to then are processed
    amplifier.session_alive();
    while (const auto event = stream.poll())
      if (const auto trouble = trouble_of(*event, stream.config().output); !trouble.empty())
        throw Failure(trouble);
    if (const auto clipped = stream.counters().saturated; clipped > 0)
      throw Failure(phrase("played.clipped", {plain(stream.config().output.uri), plain(clipped)}));
    if (amplifier.state() == audio::AmplifierState::faulted)
      throw Failure(phrase("played.amplifier", {core::phrase_of(amplifier.fault())}));
    if (const auto signal = system::StopSignals::told(); !signal.empty())
      throw Failure(phrase("played.signal", {plain(signal)}));
    if (last || stop.stop_requested()) return;
    system::sleep_until_ns(system::monotonic_ns() + kPoll_ns);
  }
}

/// Plays the bursts. Returns the frame of the first onset.
std::int64_t play(audio::Stream& stream, audio::Amplifier& amplifier, const std::vector<audio::Burst>& bursts,
                  const std::stop_token& stop) {
  const int rate_Hz = stream.config().output.rate_Hz;
  const auto margin = std::llround(kMargin_s * rate_Hz);
  auto first = bursts.at(0);
  first.start_frame = stream.earliest_frame() + std::llround(kLead_s * rate_Hz);
  // Checking the first burst can take long, so it may start later than planned. The other bursts are delayed
  // by the same time.
  const auto onset = stream.schedule_soon(first).start_frame;
  auto end = onset + first.length_frames;
  for (std::size_t k = 1; k < bursts.size(); ++k) {
    auto burst = bursts[k];
    burst.start_frame += onset - bursts[0].start_frame;
    // Compare with the render position, not the playback position. With a long device buffer, rendering runs
    // far ahead of playback.
    attend(stream, amplifier, stop, [&] { return stream.earliest_frame() + margin >= burst.start_frame; });
    if (stop.stop_requested()) return onset;
    stream.schedule(burst);
    end = burst.start_frame + burst.length_frames;
  }
  const auto left = end - stream.counters().heard;
  const auto due_ns = system::monotonic_ns() + left * 1'000'000'000 / rate_Hz + kHeard_ns;
  attend(stream, amplifier, stop, [&] {
    if (system::monotonic_ns() > due_ns)
      throw Failure(phrase("played.no_report", {plain(stream.config().output.uri)}));
    return stream.counters().heard >= end;
  });
  return onset;
}

double largest_peak(const std::vector<audio::Burst>& bursts, const audio::StreamConfig& config) {
  double peak = 0;
  for (const auto& burst : bursts)
    for (const double channel : audio::prepare(burst, format_of(config.output), config.limits).peak)
      peak = std::max(peak, channel);
  return peak;
}

}  // namespace

audio::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<audio::Burst>& bursts) {
  system::StopSignals signals;
  signals.take_over();
  return play_armed(rig, uri, bursts, {});
}

audio::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<audio::Burst>& bursts, const std::stop_token& stop) {
  auto config = session::stream_of(rig);
  config.output.uri = uri;
  // this may throw, so do it before anything is opened
  const auto peak = largest_peak(bursts, config);
  const auto amplifier = io::open_amplifier(rig.amplifier_uri);  // the amplifier must outlive the stream
  config.amplifier = amplifier.get();
  // the stream's destructor ramps down tones that are playing
  const auto stream = audio::open_realtime(config);
  attend(*stream, *amplifier, stop, [until_ns = system::monotonic_ns() + kFirstBlocks_ns] {
    return system::monotonic_ns() >= until_ns;
  });
  if (stop.stop_requested()) return audio::report_of(*stream);
  for (const auto& refusal : {amplifier->arm(), amplifier->enable()})
    if (refusal) throw Failure(phrase("played.amplifier", {core::phrase_of(*refusal)}));
  const auto onset_frame = play(*stream, *amplifier, bursts, stop);
  // after a request to stop, tones may still be playing: the stream ramps them down before the amplifier goes
  // off
  if (!stop.stop_requested()) amplifier->disarm();
  auto report = audio::report_of(*stream);
  report.peak = peak;
  report.onset_frame = onset_frame;
  return report;
}

bool can_be_felt(const rig::Rig& rig) { return rig.output.uri.starts_with("alsa:"); }

audio::PlayReport play_on_rig(const rig::Rig& rig, const audio::Burst& burst, const std::stop_token& stop) {
  if (can_be_felt(rig)) return play_armed(rig, rig.output.uri, {burst}, stop);
  auto config = session::stream_of(rig);
  config.output.uri = "null:";
  return audio::play(config, burst);
}

namespace {

constexpr double kLongest_s = 5, kUsual_s = 2, kShortestRest_s = 0.5;

}  // namespace

FeltScene feel_scene(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                     const protocol::Factors& factors, const std::stop_token& stop) {
  FeltScene felt;
  double length_s = protocol.timing.explore_s.value_or(kUsual_s);
  for (const auto* one : protocol::tasks_of(protocol))
    for (const auto& part : protocol::parts_of(one->task))
      if (std::find(part.scenes.begin(), part.scenes.end(), scene) != part.scenes.end() &&
          protocol::length_of(one->task, part) != nullptr)
        length_s = protocol::length_range_s(*one, part).second;
  felt.length_s = std::min({length_s, kLongest_s, rig.limits.continuous_s});
  felt.rest_s = std::max(kShortestRest_s, felt.length_s * (1 / rig.limits.duty - 1));
  const auto burst = session::scene_burst(rig, protocol, scene, factors, felt.length_s);
  felt.tones = burst.tones.count;
  felt.peak = play_on_rig(rig, burst, stop).peak;
  return felt;
}

}  // namespace turnpoint::maintenance
