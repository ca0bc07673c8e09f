// Tests the silence before a stimulus: what counts as a vibration, and at which level.
#include "station/sensing/silence_proof.hpp"

#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "tests/sensing/proofs.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;
using core::Proof;
using core::ProofCause;

namespace {

constexpr double kPlanned = 0.155;  // rms of three_tones(): 0.5 sqrt(0.3^2 + 0.25^2 + 0.2^2) / sqrt(2)

/// Gaussian noise with an rms of 1 around this frequency. `radius` is that of the filter's poles: the
/// half-power bandwidth is about (1 - radius) / pi of the sampling rate.
std::vector<double> noise_around(double frequency_Hz, double radius, std::size_t count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> y(count);
  double square = 0, last = 0, before = 0;
  for (auto& value : y) {
    value = normal(random) + 2 * radius * std::cos(2 * M_PI * frequency_Hz / 192000) * last -
            radius * radius * before;
    before = std::exchange(last, value);
    square += value * value;
  }
  for (auto& value : y) value /= std::sqrt(square / static_cast<double>(count));
  return y;
}

/// The silence before three_tones(), in which the pick-up's own noise is at -65 dB and `values` are added.
SilenceResult silent_with(const std::vector<double>& values, double level_dB) {
  const auto burst = three_tones();
  const std::int64_t first = burst.start_frame - 20'000;
  Room room;
  room.noise = kPlanned * std::pow(10, -65.0 / 20);
  const double factor = kPlanned * std::pow(10, level_dB / 20);
  room.extra = [&](double t) {
    return factor * values[static_cast<std::size_t>(std::llround(t * 192000 + 40'000)) % values.size()];
  };
  SilenceProof proof(plan_of(room, burst));
  const auto samples = captured(room, burst, first, 18'000);
  in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
  return proof.result();
}

}  // namespace

TEST_CASE("broadband vibration in a silence flags the trial from -40 dB on, and voids it from -30 dB on",
          "[sensing][proof]") {
  const auto values = noise_around(34e3, 0.6, 40'000);  // 24 kHz wide: no tone stands out
  std::map<Proof, double> from_dB;
  for (double level_dB = -50; level_dB <= -15; level_dB += 0.5) {
    const auto result = silent_with(values, level_dB);
    CAPTURE(level_dB, result.level_dB, result.rms_dB);
    CHECK(result.rms_dB == Approx(level_dB).margin(1));
    if (result.verdict != Proof::ok) CHECK(result.cause == ProofCause::noisy);
    from_dB.emplace(result.verdict, level_dB);
  }
  CHECK(from_dB.at(Proof::ok) == -50);
  CHECK(from_dB.at(Proof::flagged) == Approx(-40).margin(1));
  CHECK(from_dB.at(Proof::refused) == Approx(-30).margin(1));
  CHECK(from_dB.at(Proof::stopped) == Approx(-20).margin(1));
}

TEST_CASE("noise that a resonance of the plate makes narrow counts as a tone", "[sensing][proof]") {
  const auto values = noise_around(30e3, 0.992, 40'000);  // 500 Hz wide: a resonance with Q 60
  CHECK(silent_with(values, -80).verdict == Proof::ok);
  CHECK(silent_with(values, -60).verdict == Proof::flagged);
  CHECK(silent_with(values, -40).verdict == Proof::refused);
}

TEST_CASE("a silence that was not captured is lost, and without a plan nothing can be compared",
          "[sensing][proof]") {
  const Room room;
  const auto burst = three_tones();
  SilenceProof nothing(plan_of(room, burst));
  CHECK(nothing.result().verdict == Proof::lost);
  CHECK(nothing.result().cause == ProofCause::gap);

  SilenceProof proof(plan_of(room, burst));  // twice 40 ms, with a gap between them
  for (const std::int64_t first : {burst.start_frame - 20'000, burst.start_frame - 10'000}) {
    const auto samples = captured(room, burst, first, 7680);
    in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
  }
  CHECK(proof.result().verdict == Proof::lost);

  auto unplanned = plan_of(room, burst);
  unplanned.burst.tone_count = 0;
  CHECK(SilenceProof(unplanned).result().verdict == Proof::unproven);
}

TEST_CASE("silence is measured against the plan", "[sensing][proof]") {
  Room room;
  room.noise = 1e-6;
  const auto burst = three_tones();
  const auto level_of = [&](double amplitude) {
    SilenceProof proof(plan_of(room, burst));
    room.extra = [amplitude](double t) {
      return t > -0.3 && t < -0.2 ? amplitude * std::sin(2 * M_PI * 30000 * t) : 0;
    };
    const std::int64_t first = burst.start_frame - 60'000;
    const auto samples = captured(room, burst, first, 55'000);
    in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
    return proof.result();
  };
  // The rms of the plan is 0.5 sqrt(0.3^2 + 0.25^2 + 0.2^2) / sqrt(2) = 0.155, with a pick-up gain of 0.5.
  CHECK(level_of(0).verdict == Proof::ok);
  CHECK(level_of(0.155 * std::sqrt(2) * 1e-3).level_dB == Approx(-60).margin(1));
  CHECK(level_of(0.155 * std::sqrt(2) * 1e-3).verdict == Proof::flagged);
  CHECK(level_of(0.155 * std::sqrt(2) * 1e-3).cause == ProofCause::noisy);
  CHECK(level_of(0.01).verdict == Proof::refused);
}

TEST_CASE("in a silence, the pick-up's own noise is not a vibration, and a tone weaker than this noise is",
          "[sensing][proof]") {
  const auto burst = three_tones();
  constexpr double planned = 0.155;  // rms, see above
  const auto in_silence = [&](double noise_dB, double tone_dB, std::uint64_t seed) {
    Room room;
    room.seed = seed;
    room.noise = planned * std::pow(10, noise_dB / 20);
    const double amplitude = planned * std::sqrt(2) * std::pow(10, tone_dB / 20);
    room.extra = [amplitude](double t) { return amplitude * std::sin(2 * M_PI * 27312.4 * t); };
    SilenceProof proof(plan_of(room, burst));
    const std::int64_t first = burst.start_frame - 20'000;
    const auto samples = captured(room, burst, first, 18'000);
    in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
    return proof.result();
  };
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    for (const double noise_dB : {-65.0, -42.0}) {
      const auto result = in_silence(noise_dB, -200, seed);
      CAPTURE(seed, noise_dB, result.level_dB);
      CHECK(result.verdict == Proof::ok);
    }
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto weak = in_silence(-62, -68, seed);
    CHECK(weak.verdict == Proof::flagged);
    CHECK(weak.cause == ProofCause::noisy);
    // The high-pass filter weakens this tone by 0.9 dB more than the planned tones.
    CHECK(weak.level_dB == Approx(-68.9).margin(0.9));
    CHECK(in_silence(-62, -48, seed).verdict == Proof::refused);
  }
  // Noise as strong as a residual that is not accepted is not accepted in a silence, either.
  CHECK(in_silence(-35, -200, 1).verdict == Proof::flagged);
  CHECK(in_silence(-25, -200, 1).verdict == Proof::refused);
  CHECK(in_silence(-15, -200, 1).verdict == Proof::stopped);
}

TEST_CASE("a pulse of 0.1 ms in a silence voids the trial, although the rms of 50 ms hardly shows it",
          "[sensing][proof]") {
  const auto with_pulse = [](double level) {
    std::vector<double> values(40'000);
    for (std::size_t n = 0; n < 19; ++n)
      values[30'000 + n] = level * std::sin(2 * M_PI * 33e3 / 192e3 * static_cast<double>(n));
    return silent_with(values, 0);
  };
  const auto result = with_pulse(0.5);
  CHECK(result.rms_dB < -36);
  CHECK(result.verdict == Proof::refused);
  CHECK(result.cause == ProofCause::noisy);
  CHECK(with_pulse(0.02).verdict == Proof::ok);
}
