#include "tests/benchmark/sensing.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "station/drive/sine.hpp"
#include "station/drive/synth.hpp"
#include "station/sensing/carrier.hpp"
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/lock_in.hpp"
#include "tests/benchmark/stopwatch.hpp"

namespace turnpoint::benchmark {

namespace {

using namespace sensing;

constexpr double kBudget_s = 0.7;
constexpr int kRate_Hz = 192000, kChannels = 6, kBlock = 384;
constexpr std::int64_t kStart = 9600, kFrames = 2 * kRate_Hz;

drive::Burst eight_tones() {
  drive::Burst burst;
  burst.start_frame = kStart;
  burst.length_frames = kFrames - 2 * kStart;
  burst.tones.count = 8;
  for (int i = 0; i < 8; ++i)
    burst.tones.tones[static_cast<std::size_t>(i)] = {22000.5 + 3000 * i, 0.05, 0.3 * i, 0};
  return burst;
}

/// Two seconds of capture: channels 4 and 5 (the pick-ups) contain the burst, all other channels a carrier.
std::vector<std::int32_t> captured_frames() {
  const drive::Format format{kRate_Hz, 1, 24};
  drive::Synth synth(format);
  if (!synth.start(drive::prepare(eight_tones(), format))) return {};
  std::vector<std::int32_t> played(kFrames), samples(kFrames * kChannels);
  synth.render(0, std::span(played));
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1000);
  for (std::size_t n = 0; n < played.size(); ++n)
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double carrier = 1e9 * std::sin(2 * M_PI * turnpoint::terms::kForceCarrier_Hz / kRate_Hz * static_cast<double>(n));
      const double value = c >= 4 ? played[n] : carrier;
      samples[n * kChannels + c] = static_cast<std::int32_t>(value + noise(random));
    }
  return samples;
}

PickUp flat_pick_up(int channel) { return {channel, {{0, {20000, 34000, 48000}, {1, 1, 1}}}}; }

template <class Take>
void each_block(const std::vector<std::int32_t>& samples, const Take& take) {
  constexpr std::size_t size = kBlock * kChannels;
  for (std::size_t at = 0; at + size <= samples.size(); at += size)
    take(CaptureBlock{std::span(samples).subspan(at, size), kChannels,
                      static_cast<std::int64_t>(at / kChannels), kRate_Hz});
}

double synthesis_s() {
  const drive::Format format{kRate_Hz, 2, 24};
  const auto burst = drive::prepare(eight_tones(), format);
  std::vector<std::int32_t> block(2 * kBlock);
  return best_time(kBudget_s, [&] {
    drive::Synth synth(format);
    if (!synth.start(burst)) return;
    for (std::int64_t at = 0; at < kFrames; at += kBlock) synth.render(at, std::span(block));
  });
}

double lock_in_s(const std::vector<std::int32_t>& samples, const std::vector<int>& inputs) {
  const auto burst = eight_tones();
  std::vector<FollowedTone> tones;
  for (int i = 0; i < burst.tones.count; ++i) {
    const auto& tone = burst.tones.tones[static_cast<std::size_t>(i)];
    tones.push_back(
        {{drive::phase_of_angle(tone.phase_rad), drive::phase_increment(tone.frequency_Hz, kRate_Hz)},
         burst.start_frame});
  }
  double sum = 0;
  return best_time(kBudget_s, [&] {
    LockIn lock_in(kRate_Hz, kChannels, inputs, tones, 0);
    each_block(samples, [&](const CaptureBlock& block) {
      lock_in.push(block,
                   [&](double, std::span<const std::complex<double>> values) { sum += values[0].real(); });
    });
  });
}

double proof_s(const std::vector<std::int32_t>& samples) {
  IntervalPlan plan;
  plan.burst = drive::prepare(eight_tones(), {kRate_Hz, 1, 24});
  plan.capture_channels = kChannels;
  plan.pick_ups = {flat_pick_up(4), flat_pick_up(5)};
  return best_time(kBudget_s, [&] {
    IntervalProof proof(plan);
    each_block(samples, [&](const CaptureBlock& block) { proof.push(block); });
    proof.result();
  });
}

double bridges_s(const std::vector<std::int32_t>& samples) {
  BridgeOptions options;
  options.channels = kChannels;
  double sum = 0;
  return best_time(kBudget_s, [&] {
    BridgeDemodulator bridges(options);
    each_block(samples, [&](const CaptureBlock& block) {
      bridges.push(block, [&](const BridgePoint& point) { sum += point.reference; });
    });
  });
}

}  // namespace

Report bench_sensing() {
  Report report;
  report.name = "sensing";
  report.title =
      "Demodulation of eight tones and six captured channels at 192 kHz, against the synthesis of eight "
      "tones";
  report.table.columns = {"what", "ns_per_frame", "ratio"};
  const auto samples = captured_frames();
  const double synthesis = synthesis_s(), proof = proof_s(samples), bridges = bridges_s(samples);
  const auto add = [&](const char* what, double seconds) {
    report.table.rows.push_back({std::string(what), seconds / kFrames * 1e9, seconds / synthesis});
  };
  add("synthesis of eight tones", synthesis);
  add("proof of an interval, two pick-ups", proof);
  add("force from three bridges and a reference", bridges);
  add("all six channels", proof + bridges);
  add("lock-in of eight tones, one channel", lock_in_s(samples, {4}));
  add("lock-in of eight tones, two channels", lock_in_s(samples, {4, 5}));
  add("lock-in of eight tones, six channels", lock_in_s(samples, {0, 1, 2, 3, 4, 5}));
  return report;
}

}  // namespace turnpoint::benchmark
