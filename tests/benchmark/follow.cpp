#include "tests/benchmark/follow.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "station/audio/synth.hpp"
#include "station/follow/follower.hpp"
#include "station/session/follow_loop.hpp"
#include "tests/benchmark/stopwatch.hpp"

namespace turnpoint::benchmark {

namespace {

constexpr int kRepeats = 15;
constexpr int kRate_Hz = 192000, kChannels = 6, kPeriod = 96, kPeriods = 4000, kCaptured = 64;

audio::Burst burst_of(int tones) {
  audio::Burst burst;
  burst.start_frame = 9600;
  burst.length_frames = kPeriods * kPeriod - 2 * 9600;
  burst.tones.count = tones;
  for (int i = 0; i < tones; ++i)
    burst.tones.tones[static_cast<std::size_t>(i)] = {22000.0 + 3000 * i, 0.05, 0.3 * i, 0};
  return burst;
}

void synthesise() {
  const auto burst = burst_of(8);
  const audio::Format format{kRate_Hz, 2, 24};
  std::vector<std::int32_t> block(2 * kPeriod);
  audio::Synth synth(format);
  if (!synth.start(audio::prepare(burst, format))) return;
  for (std::int64_t at = 0; at < kPeriods * kPeriod; at += kPeriod) synth.render(at, std::span(block));
}

follow::Bridges bridges() {
  follow::Bridges wiring;
  wiring.channels = kChannels;
  wiring.matrix = {{{12.5, 0, 0}, {12.5, 0, 3.75}, {0, 12.5, 0}}};
  return wiring;
}

/// A strip of 0.2 m with friction that falls with displacement, and a sine of 4 mm in a closed loop.
follow::Plan plan() {
  follow::Plan plan;
  std::vector<double> x_m, displacement_m;
  for (int i = 0; i <= 200; ++i) {
    x_m.push_back(1e-3 * i);
    displacement_m.push_back(2.5e-6 * (0.7 + 0.3 * i / 200));
  }
  plan.map = follow::GainMap(x_m, displacement_m, {}, physics::FrictionMap{}, 0.008, 1);
  plan.control = follow::Control::closed;
  follow::Part sine;
  sine.shape = follow::Shape::sine, sine.from = 0.5, sine.to = 0.8, sine.cycles_per_m = 250;
  follow::add(plan.pattern, sine);
  return plan;
}

/// Captured frames of 64 periods: the carrier on all channels, with noise.
std::vector<std::int32_t> captured() {
  std::vector<std::int32_t> frames(kCaptured * kPeriod * kChannels);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1000);
  for (int n = 0; n < kCaptured * kPeriod; ++n)
    for (int c = 0; c < kChannels; ++c)
      frames[static_cast<std::size_t>(n * kChannels + c)] = static_cast<std::int32_t>(
          (c == 0 ? 0.5 : 0.05) * 0x1p31 * std::cos(2 * M_PI * 10525 * n / kRate_Hz) + noise(random));
  return frames;
}

/// Forces from the frames of each period, and with `follower` also its gains. The finger strokes to and fro.
void follow_finger(const std::vector<std::int32_t>& frames, follow::BridgeWindow window,
                   follow::Follower* follower) {
  volatile double sum = 0;
  for (std::int64_t k = 0; k < kPeriods; ++k) {
    window.push(k * kPeriod, frames.data() + k % kCaptured * kPeriod * kChannels, kPeriod);
    auto sample = window.sample();
    sum = sum + sample.normal_N;
    if (follower == nullptr) continue;
    const double t = 0.5e-3 * static_cast<double>(k);
    sample.fault = follow::Fault::none;
    sample.normal_N = 0.5, sample.lateral_N = 0.3 * (std::cos(3 * t) > 0 ? 1 : -1);
    sample.moment_Nm = 0.5 * (0.1 + 0.05 * std::sin(3 * t));
    sum = sum + static_cast<double>(follower->update((k + 3) * kPeriod, sample).gain[0]);
  }
}

/// The whole way of a trial, as session and stream join it: each captured period goes to the loop, which
/// sends its gains through the stream's ring, and the synthesis multiplies its tones by them. The captured
/// forces are those of a finger of 2.5 N that rests at 150 mm.
void join(const std::vector<std::int32_t>& frames, const std::shared_ptr<const follow::Plan>& plan,
          int tones) {
  audio::StreamConfig config;
  config.output.rate_Hz = kRate_Hz;
  config.output.period_frames = kPeriod;
  config.output.periods = 2;
  config.virtual_lead_frames = 2 * kPeriod;
  config.samples = audio::Samples::rendered;
  const auto stream = audio::open_synchronous(config);
  session::FollowLoop loop(*stream, kChannels);
  auto burst = burst_of(tones);
  burst.following = {1, 0, 960, 960, 1920};
  const auto prepared = audio::prepare(burst, audio::format_of(stream->config().output));
  sensing::FingerSetup cells;
  cells.bridges.channels = kChannels;
  cells.bridges.reference_amplitude = 0.5;
  cells.calibration = sensing::ForceCalibration({{{12.5, 0, 0}, {12.5, 0, 3750}, {0, 12.5, 0}}}, {});
  loop.prepare({plan}, {&prepared, 1}, cells);
  const auto scheduled = stream->schedule_together({&prepared, 1});
  const std::array bursts{session::FollowLoop::Burst{scheduled[0].burst, scheduled[0].start_frame,
                                                     scheduled[0].start_frame + prepared.length_frames}};
  loop.begin(bursts, sensing::Readings{}, {});
  for (std::int64_t k = 0; k < kPeriods; ++k) {
    loop.captured(k * kPeriod, 0,
                  std::span(frames).subspan(static_cast<std::size_t>(k % kCaptured * kPeriod * kChannels),
                                            kPeriod * kChannels));
    stream->advance(kPeriod);
    if (k % 1000 != 0) continue;
    while (stream->poll()) {
    }
    loop.gather();
  }
  const auto followed = loop.take();
  if (followed.periods.size() < kPeriods / 2 || followed.periods.back().update.following < 1)
    throw std::logic_error("the joined way did not follow");
}

}  // namespace

Report bench_follow() {
  const auto frames = captured();
  const follow::BridgeWindow window(bridges(), {}, {});
  const auto shared = std::make_shared<const follow::Plan>(plan());
  const follow::Follower fresh(*shared);
  const std::vector<Work> works{
      {"synthesis of eight tones", synthesise},
      {"following the finger, whole update",
       [&] {
         auto follower = fresh;
         follow_finger(frames, window, &follower);
       }},
      {"of it: forces from four captured channels", [&] { follow_finger(frames, window, nullptr); }},
      {"joined: loop, ring of gains, synthesis of one tone", [&] { join(frames, shared, 1); }},
      {"joined: loop, ring of gains, synthesis of eight tones", [&] { join(frames, shared, 8); }}};
  Report report;
  report.name = "follow";
  report.title = fmt::format(
      "Updates of a gain that follows the finger, one in 96 frames at 192 kHz, against the synthesis of "
      "eight "
      "tones; medians of {} repeats of processor time",
      kRepeats);
  report.table.columns = {"what", "us_per_update", "share_of_core", "ratio", "lowest_ratio", "highest_ratio"};
  for (const Compared& compared : compare(works, kRepeats))
    report.table.rows.push_back({compared.name, compared.time_s / kPeriods * 1e6,
                                 compared.time_s * kRate_Hz / (1.0 * kPeriods * kPeriod), compared.ratio,
                                 compared.lowest_ratio, compared.highest_ratio});
  return report;
}

}  // namespace turnpoint::benchmark
