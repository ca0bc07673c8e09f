// Tests IntervalProof with random bursts and random simulated rooms. Without a fault, each burst must be
// proven; with a fault, the verdict must name it.
#include <cmath>
#include <random>

#include "tests/sensing/proofs.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;
using core::Proof;
using core::ProofCause;

namespace {

double planned_rms(const Room& room, const audio::Burst& burst) {
  double square = 0;
  for (int i = 0; i < burst.tones.count; ++i) {
    const audio::Tone& tone = burst.tones.tones[static_cast<std::size_t>(i)];
    square += std::norm(tone.amplitude * room.pick_ups[0].response(tone.frequency_Hz)) / 2;
  }
  return std::sqrt(square);
}

/// Returns a room without faults, whose levels are within 0.3 dB of the plan and whose noise is 10^-4.5 to
/// 10^-2.5 of full scale.
Room random_room(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Room room;
  room.channels = 2;
  room.seed = random();
  room.delay_frames = 96000 * uniform(random);
  room.drive_gain = std::pow(10, (0.6 * uniform(random) - 0.3) / 20);
  room.pick_ups[0] = {static_cast<int>(random() % 2), 0.2 + 0.6 * uniform(random), 6 * uniform(random),
                      3e-4 * uniform(random)};
  room.noise = std::pow(10, -4.5 + 2 * uniform(random));
  return room;
}

}  // namespace

TEST_CASE("of a thousand clean intervals, all are proven", "[sensing][proof]") {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 1000; ++k) {
    Room room = random_room(random);
    const auto burst = random_burst(random, 1 + k % 8, 0.02 + 0.03 * uniform(random));
    room.noise *= planned_rms(room, burst);
    const IntervalResult result = proven(room, burst);
    if (result.verdict != Proof::ok)
      FAIL_CHECK(k << ": " << name(result.verdict) << " " << name(result.cause) << " " << result.ratio_dB
                   << " dB, residual " << result.residual_dB << " dB, onset "
                   << result.onset_error_us.value_or(-1) << " us");
  }
}

TEST_CASE("each fault of the drive is named in random intervals", "[sensing][proof]") {
  std::mt19937_64 random(14);
  const ProofCause causes[] = {ProofCause::dead, ProofCause::half,    ProofCause::frequency,
                               ProofCause::late, ProofCause::clipped, ProofCause::level};
  for (int k = 0; k < 120; ++k) {
    Room room = random_room(random);
    const auto burst = random_burst(random, 1 + k % 8, 0.1);
    const double rms = planned_rms(room, burst);
    room.noise *= rms;
    const ProofCause cause = causes[k % 6];
    if (cause == ProofCause::dead) room.drive_gain = 0;
    if (cause == ProofCause::half) room.drive_gain *= 0.5;
    if (cause == ProofCause::frequency) room.frequency_factor = 1.03;
    if (cause == ProofCause::late) room.late_s = 0.005;
    if (cause == ProofCause::clipped) room.limiter = 1.1 * rms;
    if (cause == ProofCause::level) room.drive_gain = 0.8;
    const IntervalResult result = proven(room, burst);
    if (result.cause != cause || (result.verdict != Proof::refused && result.verdict != Proof::stopped))
      FAIL_CHECK(k << ": " << burst.tones.count << " tones, " << name(cause) << " judged as "
                   << name(result.verdict) << " " << name(result.cause) << ", " << result.ratio_dB
                   << " dB, residual " << result.residual_dB << " dB, product "
                   << (result.product ? name(*result.product) : "") << " "
                   << (result.product ? result.product->level_dB : 0) << " dB, onset "
                   << result.onset_error_us.value_or(-1) << " us");
  }
}
