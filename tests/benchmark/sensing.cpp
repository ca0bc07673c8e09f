#include "tests/benchmark/sensing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/sine.hpp"
#include "station/audio/synth.hpp"
#include "station/sensing/carrier.hpp"
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/lock_in.hpp"
#include "tests/benchmark/stopwatch.hpp"

namespace turnpoint::benchmark {

namespace {

using namespace sensing;

constexpr int kRepeats = 15;
constexpr int kRate_Hz = 192000, kChannels = 6, kBlock = 384;
constexpr std::int64_t kStart = 9600, kFrames = 2 * kRate_Hz, kBuffer = 4 * kBlock;
// In the device's buffer, all tones and the carrier have whole numbers of cycles.
constexpr double kStep_Hz = 1.0 * kRate_Hz / kBuffer, kCarrier_Hz = 84 * kStep_Hz;

audio::Burst eight_tones() {
  audio::Burst burst;
  burst.start_frame = kStart;
  burst.length_frames = kFrames - 2 * kStart;
  burst.tones.count = 8;
  for (int i = 0; i < 8; ++i)
    burst.tones.tones[static_cast<std::size_t>(i)] = {kStep_Hz * (176 + 24 * i), 0.05, 0.3 * i, 0};
  return burst;
}

/// The buffer of a capture device with the default of four periods, which is captured over and over. Channels
/// 4 and 5 (the pick-ups) contain the eight tones, all other channels a carrier.
std::vector<std::int32_t> device_buffer() {
  std::vector<std::int32_t> samples(kBuffer * kChannels);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1000);
  const auto tones = eight_tones().tones;
  for (std::int64_t n = 0; n < kBuffer; ++n) {
    const double turn = 2 * M_PI * static_cast<double>(n) / kRate_Hz;
    double moved = 0;
    for (const auto& tone : std::span(tones.tones).first(static_cast<std::size_t>(tones.count)))
      moved += 0x1p31 * tone.amplitude * std::sin(turn * tone.frequency_Hz + tone.phase_rad);
    const double carrier = 1e9 * std::sin(turn * kCarrier_Hz);
    for (int c = 0; c < kChannels; ++c)
      samples[static_cast<std::size_t>(n * kChannels + c)] =
          static_cast<std::int32_t>((c >= 4 ? moved : carrier) + noise(random));
  }
  return samples;
}

PickUp flat_pick_up(int channel) { return {channel, {{0, {20000, 34000, 48000}, {1, 1, 1}}}}; }

template <class Take>
void each_block(const std::vector<std::int32_t>& buffer, const Take& take) {
  constexpr std::size_t size = kBlock * kChannels;
  for (std::int64_t at = 0; at + kBlock <= kFrames; at += kBlock)
    take(CaptureBlock{std::span(buffer).subspan(static_cast<std::size_t>(at % kBuffer * kChannels), size),
                      kChannels, at, kRate_Hz});
}

void synthesise() {
  const audio::Format format{kRate_Hz, 2, 24};
  std::vector<std::int32_t> block(2 * kBlock);
  audio::Synth synth(format);
  if (!synth.start(audio::prepare(eight_tones(), format))) return;
  for (std::int64_t at = 0; at < kFrames; at += kBlock) synth.render(at, std::span(block));
}

void lock_in(const std::vector<std::int32_t>& samples, const std::vector<int>& inputs) {
  const auto burst = eight_tones();
  std::vector<FollowedTone> tones;
  for (int i = 0; i < burst.tones.count; ++i) {
    const auto& tone = burst.tones.tones[static_cast<std::size_t>(i)];
    tones.push_back(
        {{audio::phase_of_angle(tone.phase_rad), audio::phase_increment(tone.frequency_Hz, kRate_Hz)},
         burst.start_frame});
  }
  LockIn lock_in(kRate_Hz, kChannels, inputs, tones, 0);
  each_block(samples, [&](const CaptureBlock& block) { lock_in.push(block, [](double, const auto&) {}); });
}

IntervalPlan interval_plan() {
  IntervalPlan plan;
  plan.burst = audio::prepare(eight_tones(), {kRate_Hz, 1, 24});
  plan.capture_channels = kChannels;
  plan.pick_ups = {flat_pick_up(4), flat_pick_up(5)};
  return plan;
}

BridgeOptions bridge_options() {
  BridgeOptions options;
  options.channels = kChannels;
  options.carrier_Hz = kCarrier_Hz;
  return options;
}

void prove(const std::vector<std::int32_t>& samples) {
  IntervalProof proof(interval_plan());
  each_block(samples, [&](const CaptureBlock& block) { proof.push(block); });
  proof.result();
}

void measure_forces(const std::vector<std::int32_t>& samples) {
  BridgeDemodulator bridges(bridge_options());
  each_block(samples, [&](const CaptureBlock& block) { bridges.push(block, [](const BridgePoint&) {}); });
}

/// What a session does with captured samples: the capture thread puts them into a ring, the sensing thread
/// takes them from there, proves the interval and measures the forces.
struct SessionCapture {
  audio::CaptureRing ring;
  BridgeDemodulator bridges{bridge_options()};
  std::int64_t frames = 0;  ///< number of frames that the bridges have received
};

/// One trial: takes all frames, and proves its interval.
void capture_and_demodulate(const std::vector<std::int32_t>& samples, SessionCapture& session) {
  auto& [ring, bridges, frames] = session;
  IntervalProof proof(interval_plan());
  each_block(samples, [&](const CaptureBlock& block) {
    constexpr std::size_t most = audio::CapturedBlock::kSamples / kChannels * kChannels;
    for (std::size_t at = 0; at < block.samples.size(); at += most) {
      const auto part = block.samples.subspan(at, std::min(most, block.samples.size() - at));
      const bool pushed = ring.fill([&](audio::CapturedBlock& in) {
        in.first_frame = block.first_frame + static_cast<std::int64_t>(at / kChannels);
        in.count = static_cast<std::int32_t>(part.size());
        std::copy_n(part.data(), part.size(), in.samples.data());
      });
      const auto* out = ring.take();
      if (!pushed || out == nullptr) return;
      const CaptureBlock taken{out->used(), kChannels, out->first_frame, kRate_Hz};
      proof.push(taken);
      bridges.push({taken.samples, kChannels, frames, kRate_Hz}, [](const BridgePoint&) {});
      frames += taken.frames();
    }
  });
  proof.result();
}

}  // namespace

Report bench_sensing() {
  const auto samples = device_buffer();
  const auto session = std::make_unique<SessionCapture>();
  const std::vector<Work> works{
      {"synthesis of eight tones", synthesise},
      {"capture and demodulation of six channels", [&] { capture_and_demodulate(samples, *session); }},
      {"proof of an interval, two pick-ups", [&] { prove(samples); }},
      {"force from three bridges and a reference", [&] { measure_forces(samples); }},
      {"lock-in of eight tones, one channel", [&] { lock_in(samples, {4}); }},
      {"lock-in of eight tones, two channels",
       [&] {
         lock_in(samples, {4, 5});
       }},
      {"lock-in of eight tones, six channels", [&] {
         lock_in(samples, {0, 1, 2, 3, 4, 5});
       }}};
  Report report;
  report.name = "sensing";
  report.title = fmt::format(
      "Demodulation of eight tones and six captured channels at 192 kHz, against the synthesis of eight "
      "tones; "
      "medians of {} repeats of processor time",
      kRepeats);
  report.table.columns = {"what", "ns_per_frame", "ratio", "lowest_ratio", "highest_ratio"};
  for (const Compared& compared : compare(works, kRepeats))
    report.table.rows.push_back({compared.name, compared.time_s / kFrames * 1e9, compared.ratio,
                                 compared.lowest_ratio, compared.highest_ratio});
  return report;
}

}  // namespace turnpoint::benchmark
