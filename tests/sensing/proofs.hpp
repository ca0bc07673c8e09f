#pragma once
// Bursts that the tests of IntervalProof play in a simulated room, and the result for such a burst.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "station/audio/synth.hpp"
#include "station/sensing/interval_proof.hpp"
#include "tests/sensing/room.hpp"
#include "tests/support/catch.hpp"

namespace turnpoint::sensing {

inline audio::Burst burst_of(std::vector<audio::Tone> tones, std::int64_t length = 76800,
                             std::int64_t ramp = 960) {
  audio::Burst burst;
  burst.start_frame = 123'456'789'012;
  burst.length_frames = length;
  burst.ramp.frames = ramp;
  burst.tones.count = static_cast<std::int32_t>(tones.size());
  std::copy(tones.begin(), tones.end(), burst.tones.tones.begin());
  return burst;
}

inline audio::Burst three_tones() {
  return burst_of({{25000.5, 0.3, 0.2, 0}, {30321.7, 0.25, 1.9, 0}, {36543.2, 0.2, -2.5, 0}});
}

/// Tones at least 1 kHz apart between 22 and 46 kHz. Phases are random, and levels are random within 10 dB.
inline audio::Burst random_burst(std::mt19937_64& random, int tones, double steady_s) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<audio::Tone> made;
  const double room_Hz = 24000.0 - 1000.0 * (tones - 1);
  std::vector<double> places;
  for (int i = 0; i < tones; ++i) places.push_back(room_Hz * uniform(random));
  std::sort(places.begin(), places.end());
  for (int i = 0; i < tones; ++i)
    made.push_back({22000 + 1000.0 * i + places[static_cast<std::size_t>(i)],
                    0.9 / tones * std::pow(10, -0.5 * uniform(random)), 6.28 * uniform(random), 0});
  auto burst = burst_of(made, 2 * 960 + std::llround(192000 * (steady_s + 0.01)));
  burst.start_frame = static_cast<std::int64_t>(random() % 1'000'000'000'000);
  return burst;
}

inline IntervalPlan plan_of(const Room& room, const audio::Burst& burst) {
  IntervalPlan plan;
  plan.burst = audio::prepare(burst, {room.rate_Hz, 2, 24});
  plan.rate_Hz = room.rate_Hz;
  plan.capture_channels = room.channels;
  for (const SimplePickUp& pick_up : room.pick_ups) plan.pick_ups.push_back(calibrated(pick_up));
  plan.delay_frames = room.delay_frames;
  return plan;
}

inline IntervalResult proven(const Room& room, const audio::Burst& burst,
                             std::optional<bool> in_contact = false,
                             const IntervalPlan* other_plan = nullptr) {
  IntervalProof proof(other_plan != nullptr ? *other_plan : plan_of(room, burst));
  const std::int64_t first = proof.first_frame();
  const auto samples = captured(room, burst, first, proof.end_frame() - first);
  in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
  CHECK(proof.complete());
  return proof.result(in_contact);
}

}  // namespace turnpoint::sensing
