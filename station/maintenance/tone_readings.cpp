#include "station/maintenance/tone_readings.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <span>
#include <utility>

#include "station/audio/engine.hpp"
#include "station/audio/prepared_burst.hpp"
#include "station/audio/sine.hpp"
#include "station/maintenance/captured_sweep.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/sensing/lock_in.hpp"
#include "station/session/session.hpp"
#include "station/session/simulated_room.hpp"
#include "station/session/stage.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::maintenance {

namespace {

constexpr double kEvery_s = 0.2;  // time between two readings

/// Reads the amplitude of a tone from what the pick-ups capture.
class Reader {
 public:
  Reader(const rig::Rig& rig, double frequency_Hz, OnToneReadings on_readings)
      : channels_(rig.capture->channels),
        rate_Hz_(rig.output.rate_Hz),
        pick_ups_(rig.capture->pick_ups),
        on_readings_(std::move(on_readings)),
        lock_in_(rate_Hz_, channels_, pick_ups_, {followed(frequency_Hz, rate_Hz_)}, 0) {
    const auto calibrated = known_calibration(rig).pick_ups;
    for (const int channel : pick_ups_) {
      const auto known = std::find_if(calibrated.begin(), calibrated.end(), [&](const auto& pick_up) {
        return pick_up.response.channel == channel && pick_up.scale;
      });
      um_per_full_scale_.push_back(known == calibrated.end() ? std::nullopt
                                                             : std::optional(known->scale->at(frequency_Hz)));
    }
  }

  void push(std::span<const std::int32_t> samples, std::int64_t first_frame) {
    lock_in_.push({samples, channels_, first_frame, rate_Hz_}, [this](double frame, auto values) {
      if (frame < due_frame_ || !std::isfinite(std::abs(values.front()))) return;
      due_frame_ = frame + kEvery_s * rate_Hz_;
      tell(values);
    });
  }

 private:
  /// The tone, whenever it begins: its phase does not matter for the amplitude.
  static sensing::FollowedTone followed(double frequency_Hz, int rate_Hz) {
    sensing::FollowedTone made;
    made.partial.increment = audio::phase_increment(frequency_Hz, rate_Hz);
    return made;
  }

  void tell(std::span<const std::complex<double>> values) const {
    std::vector<ToneReading> readings;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double amplitude = std::abs(values[k]);
      const auto scale = um_per_full_scale_[k];
      readings.push_back({pick_ups_[k], amplitude, scale ? std::optional(*scale * amplitude) : std::nullopt});
    }
    on_readings_(readings);
  }

  int channels_, rate_Hz_;
  std::vector<int> pick_ups_;
  std::vector<std::optional<double>> um_per_full_scale_;
  OnToneReadings on_readings_;
  sensing::LockIn lock_in_;
  double due_frame_ = 0;
};

/// Plays the tone in the simulated laboratory, at the pace of real time.
void play_simulated(const rig::Rig& rig, const audio::Burst& tone, const std::stop_token& stop,
                    Reader& reader) {
  session::SimulatedRoom room(rig);
  auto config = session::stream_of(rig);
  config.output.uri = "null:";
  const auto stream = audio::open_synchronous(config);
  stream->listen([&](std::int64_t first_frame, std::span<const std::int32_t> played) {
    const auto captured = room.advance(first_frame, played);
    reader.push(captured.samples, captured.first_frame);
  });
  room.expect(std::vector{audio::prepare(tone, audio::format_of(config.output), config.limits)});
  stream->schedule(tone);
  const auto begun_ns = system::monotonic_ns();
  const auto step = std::llround(kEvery_s * rig.output.rate_Hz);
  while (stream->frame() < tone.length_frames && !stop.stop_requested()) {
    stream->advance(std::min<std::int64_t>(step, tone.length_frames - stream->frame()));
    system::sleep_until_ns(begun_ns + stream->frame() * 1'000'000'000 / rig.output.rate_Hz);
  }
}

}  // namespace

bool reads_tones(const rig::Rig& rig) {
  if (!rig.capture || rig.capture->pick_ups.empty()) return false;
  return can_be_felt(rig) == !session::simulates_capture(rig);
}

void play_and_read(const rig::Rig& rig, const audio::Burst& tone, const std::stop_token& stop,
                   const OnToneReadings& on_readings) {
  if (!reads_tones(rig)) {
    play_on_rig(rig, tone, stop);
    return;
  }
  Reader reader(rig, tone.tones.tones[0].frequency_Hz, on_readings);
  if (!can_be_felt(rig)) return play_simulated(rig, tone, stop, reader);
  CaptureThread capture(
      session::card_capture_of(rig).value().device,
      [&reader](const audio::CapturedBlock& block) { reader.push(block.used(), block.first_frame); });
  play_on_rig(rig, tone, stop);
  capture.end();
}

}  // namespace turnpoint::maintenance
