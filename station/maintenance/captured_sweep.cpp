#include "station/maintenance/captured_sweep.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "station/audio/engine.hpp"
#include "station/core/texts.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/sensing/pilot.hpp"
#include "station/session/capture_feed.hpp"
#include "station/session/session.hpp"
#include "station/session/simulated_room.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::maintenance {

CaptureThread::CaptureThread(const audio::OutputConfig& device, OnBlock on_block)
    : device_(device),
      on_block_(std::move(on_block)),
      capture_(audio::open_capture(device)),
      thread_([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          take();
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
      }) {}

audio::CaptureCounters CaptureThread::end() {
  thread_.request_stop();
  thread_.join();
  take();
  const auto counters = capture_->counters();
  if (!counters.present) throw core::Failure(core::phrase("played.disconnected", {core::plain(device_.uri)}));
  return counters;
}

void CaptureThread::take() {
  while (const auto* block = capture_->take()) on_block_(*block);
}

namespace {

constexpr double kTail_s = 0.5;

audio::StreamConfig silent_stream(const rig::Rig& rig) {
  auto config = session::stream_of(rig);
  config.output.uri = "null:";
  return config;
}

void append(const sensing::CaptureBlock& block, std::vector<std::vector<double>>& channels) {
  const auto count = static_cast<std::size_t>(block.channels);
  for (std::size_t k = 0; k < block.samples.size(); ++k)
    channels[k % count].push_back(0x1p-31 * block.samples[k]);
}

/// Records everything that a device captures.
class Recorder {
 public:
  explicit Recorder(const audio::OutputConfig& device)
      : device_(device), thread_(device, [this](const audio::CapturedBlock& block) { take(block); }) {}

  /// Ends the recording. The samples are interleaved. Throws std::runtime_error if frames are missing.
  std::vector<std::int32_t> end() {
    const auto counters = thread_.end();
    if (lost_ || counters.lost_frames > 0 || counters.unknown_gaps > 0)
      throw std::runtime_error(device_.uri + ": captured frames were lost; start the command again");
    return std::move(samples_);
  }

 private:
  void take(const audio::CapturedBlock& block) {
    const auto next = static_cast<std::int64_t>(samples_.size()) / device_.channels;
    lost_ = lost_ || block.first_frame != next || block.numbering != 0;
    const auto used = block.used();
    samples_.insert(samples_.end(), used.begin(), used.end());
  }

  const audio::OutputConfig device_;
  std::vector<std::int32_t> samples_;
  bool lost_ = false;
  // The last member, so that its thread ends before the objects that it uses are destroyed.
  CaptureThread thread_;
};

}  // namespace

std::vector<double> rendered(const rig::Rig& rig, const audio::Burst& burst, int channel) {
  const auto stream = audio::open_synchronous(silent_stream(rig));
  auto at_start = burst;
  at_start.start_frame = 0;
  std::vector<double> samples;
  const auto channels = stream->config().output.channels;
  stream->listen([&](std::int64_t, std::span<const std::int32_t> played) {
    for (auto k = static_cast<std::size_t>(channel); k < played.size();
         k += static_cast<std::size_t>(channels))
      samples.push_back(0x1p-31 * played[k]);
  });
  stream->schedule(at_start);
  stream->advance(burst.length_frames);
  return samples;
}

Captured capture_simulated(const rig::Rig& rig, const std::vector<audio::Burst>& bursts,
                           const std::function<void(simulation::Setup&)>& laboratory,
                           const simulation::Load& load) {
  session::SimulatedRoom room(rig, laboratory);
  room.plant().set_load(load);
  const auto stream = audio::open_synchronous(silent_stream(rig));
  Captured made;
  made.channels.resize(static_cast<std::size_t>(rig.capture.value().channels));
  made.delay_frames = room.capture().delay_frames;
  stream->listen([&](std::int64_t first_frame, std::span<const std::int32_t> played) {
    append(room.advance(first_frame, played), made.channels);
  });
  for (const auto& burst : bursts) {
    stream->schedule(burst);
    stream->advance(burst.start_frame + burst.length_frames - stream->frame());
    while (stream->poll()) {
    }
  }
  stream->advance(std::llround(kTail_s * rig.output.rate_Hz));
  return made;
}

Captured capture_armed(const rig::Rig& rig, const std::vector<audio::Burst>& bursts) {
  const auto plan = session::card_capture_of(rig).value();
  auto all = bursts;
  all.insert(all.begin(), sensing::pilot_burst(plan.pilot, 0));
  Recorder recorder(plan.device);
  const auto report = play_armed(rig, rig.output.uri, all);
  std::this_thread::sleep_for(std::chrono::milliseconds(std::llround(1e3 * kTail_s)));
  const auto samples = recorder.end();
  const sensing::CaptureBlock block{samples, plan.device.channels, 0, plan.device.rate_Hz};
  const double longest_s =
      static_cast<double>(block.frames() - plan.pilot.frames - 256) / plan.device.rate_Hz;
  // the listener needs 64 captured frames from before the pilot, the chirp that shows the delay
  sensing::PilotListener listener(plan.pilot, 64, plan.device.channels, plan.reference, longest_s);
  listener.push(block);
  const auto echo = listener.find();
  if (!echo)
    throw std::runtime_error(fmt::format(
        "{}: the pilot on output channel {} did not come back on captured channel {}; wire them together",
        plan.device.uri, plan.pilot.channel, plan.reference));
  Captured made;
  made.channels.resize(static_cast<std::size_t>(plan.device.channels));
  append(block, made.channels);
  const double heard = echo->delay_frames + 64;  // captured frame in which the pilot begins
  made.first_frame = -std::llround(heard);
  made.delay_frames = heard + static_cast<double>(made.first_frame);
  return made;
}

}  // namespace turnpoint::maintenance
