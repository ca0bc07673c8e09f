#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "station/audio/synth.hpp"
#include "station/sensing/follow_proof.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;
using core::Proof;
using core::ProofCause;

namespace {

constexpr int kRate = 192000;
constexpr std::int64_t kPeriod = 96, kStart = 4800;
constexpr double pi = std::numbers::pi;

/// A plate with one resonance: y = x + 2 r cos(w) y1 - r^2 y2, whose response is known exactly.
struct Plate {
  Plate(double resonance_Hz, double quality)
      : r(std::exp(-pi * resonance_Hz / quality / kRate)), w(2 * pi * resonance_Hz / kRate) {}
  double step(double x) {
    const double y = x + 2 * r * std::cos(w) * y1 - r * r * y2;
    y2 = y1, y1 = y;
    return y;
  }
  std::complex<double> response(double frequency_Hz) const {
    const auto z = std::polar(1.0, -2 * pi * frequency_Hz / kRate);
    return 1.0 / (1.0 - 2 * r * std::cos(w) * z + r * r * z * z);
  }
  double r, w, y1 = 0, y2 = 0;
};

using Gain = std::function<double(std::int64_t frame)>;

/// What a pick-up captures of a burst that follows these gains.
struct Room {
  double resonance_Hz = 30200, quality = 60, delay_frames = 400;
  std::vector<double> tones{30000};
  double noise = 1e-5,
         per_unit = 0;           // of the pick-up, and its signal per unit of the plate (0: 0.3 at the tone)
  std::int64_t played_late = 0;  // the gains act so many frames later than they say
  double scale = 1;
  double cubic = 0;  // distortion of the amplifier
  std::int64_t lost_at = -1, length = 96000;
  Gain finger = [](auto) { return 1.0; };  // what it does to the level

  Plate plate() const { return {resonance_Hz, quality}; }
  double unit() const {
    return 0.3 / std::abs(plate().response(tones.front())) / static_cast<double>(tones.size());
  }

  audio::PreparedBurst burst() const {
    audio::Burst made;
    made.start_frame = kStart;
    made.length_frames = length;
    made.ramp.frames = 4800;
    for (const double f : tones)
      made.tones.tones[static_cast<std::size_t>(made.tones.count++)] = {
          f, 0.4 / static_cast<double>(tones.size()), 0.3, 0};
    made.following = {1, 0, 960, 960, 1920};
    auto prepared = audio::prepare(made, {kRate, 1, 24});
    prepared.id = 1;
    return prepared;
  }

  IntervalResult judged(const Gain& commanded, const Gain& played) const {
    IntervalPlan plan{burst(), kRate, 1, {}, delay_frames, {}};
    PickUp pick_up{0, {{0, {}, {}}}};
    for (double f = 20000; f <= 45000; f += 20) {
      pick_up.transfers[0].frequency_Hz.push_back(f);
      pick_up.transfers[0].response.push_back(unit() * plate().response(f));
    }
    plan.pick_ups = {pick_up};
    FollowProof proof(plan);
    audio::Synth synth({kRate, 1, 24});
    REQUIRE(synth.start(burst()));
    Plate world = plate();
    std::vector<double> drive, block(kPeriod);
    const std::int64_t frames = kStart + length + 9600;
    for (std::int64_t frame = 0; frame < frames; frame += kPeriod) {
      audio::GainPeriod gains{1, kPeriod, frame, {}};
      for (std::size_t k = 0; k < 8; ++k)
        gains.gain[k] =
            static_cast<float>(played(frame + 12 * static_cast<std::int64_t>(k + 1) - played_late));
      synth.follow(gains);
      synth.render(frame, std::span<double>(block));
      drive.insert(drive.end(), block.begin(), block.end());
    }
    std::vector<std::int32_t> captured;
    std::uint64_t state = 88172645463325252u;
    const auto whole = static_cast<std::int64_t>(delay_frames);
    for (std::int64_t n = 0; n < frames; ++n) {
      const double x = n >= whole ? drive[static_cast<std::size_t>(n - whole)] : 0;
      const double y = world.step(x + cubic * x * x * x);
      state ^= state << 13, state ^= state >> 7, state ^= state << 17;
      const double dice = static_cast<double>(static_cast<std::int64_t>(state)) * 0x1p-63;
      captured.push_back(
          static_cast<std::int32_t>(std::lround((scale * finger(n) * unit() * y + noise * dice) * 0x1p31)));
    }
    for (std::int64_t n = 0; n < frames; n += 480)
      if (lost_at < 0 || n + 480 <= lost_at || n > lost_at)
        proof.push({std::span(captured).subspan(static_cast<std::size_t>(n), 480), 1, n, kRate});
    CommandedEnvelope envelope{12, 12, {}};
    for (std::int64_t frame = 12; frame < frames; frame += 12) envelope.gain.push_back(commanded(frame));
    return proof.result(envelope, false);
  }
  IntervalResult judged(const Gain& gain) const { return judged(gain, gain); }
};

double texture(std::int64_t n) { return 0.5 + 0.3 * std::sin(2 * pi * 50 * static_cast<double>(n) / kRate); }
/// A sum of sines around 1, of this share (rms) and of random frequencies and phases in this range.
Gain waves(std::mt19937_64& random, double rms, double lowest_Hz, double highest_Hz) {
  constexpr std::size_t count = 6;
  std::array<double, count> frequency_Hz{}, phase{};
  for (std::size_t i = 0; i < count; ++i) {
    frequency_Hz[i] = std::uniform_real_distribution(lowest_Hz, highest_Hz)(random);
    phase[i] = std::uniform_real_distribution(0.0, 2 * pi)(random);
  }
  return [=](std::int64_t n) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i)
      sum += std::sin(2 * pi * frequency_Hz[i] * static_cast<double>(n) / kRate + phase[i]);
    return 1 + rms * std::sqrt(2.0 / count) * sum;
  };
}

double edge(std::int64_t n) {
  return n < 50000 ? 0.2 : n > 50960 ? 0.8 : 0.2 + 0.6 * static_cast<double>(n - 50000) / 960;
}

}  // namespace

TEST_CASE("a plate that follows its gains is proven, with its level, its error and its lag",
          "[sensing][follow]") {
  for (const Gain& gain : {Gain(texture), Gain(edge)}) {
    const auto result = Room{}.judged(gain);
    CHECK(result.verdict == Proof::ok);
    CHECK(result.cause == ProofCause::none);
    CHECK(std::abs(result.ratio_dB) < 0.05);
    CHECK(result.envelope_error_dB.value() < -45);
    CHECK(std::abs(result.envelope_lag_us.value()) < 5);
    REQUIRE(result.tones.size() == 1);
    CHECK(result.tones[0].seen);
    CHECK(std::abs(result.tones[0].phase_error_deg) < 0.5);
  }
}

TEST_CASE("so are several tones with a common gain, and a plate that rings long", "[sensing][follow]") {
  Room room;
  room.tones = {29000, 30000, 31050};
  CHECK(room.judged(texture).verdict == Proof::ok);
  CHECK(room.judged(texture).envelope_error_dB.value() < -33);
  room = {};
  room.quality = 500;
  room.resonance_Hz = 30010;
  const auto result = room.judged(texture);
  CHECK(result.verdict == Proof::ok);
  CHECK(result.envelope_error_dB.value() < -33);
}

TEST_CASE("a gain that jumps within a block does not look early or wrong", "[sensing][follow]") {
  // It rises in two eighths of a period, as fast as a follower may command it, and falls slowly.
  std::mt19937_64 random(7);
  for (int k = 0; k < 12; ++k) {
    CAPTURE(k);
    const auto first = std::uniform_int_distribution<std::int64_t>(20000, 24000)(random) / 12 * 12;
    const auto jumps = [first](std::int64_t n) {
      const std::int64_t since = n - first;
      if (since < 0) return 0.3;
      if (since < 24) return 0.3 + 0.7 * static_cast<double>(since) / 24;
      return 0.3 + 0.7 * std::max(0.0, 1 - static_cast<double>(since - 24) / 48000);
    };
    const auto result = Room{}.judged(jumps);
    CAPTURE(result.envelope_error_dB.value(), result.envelope_lag_us.value_or(NAN));
    CHECK(result.verdict == Proof::ok);
    CHECK(result.envelope_error_dB.value() < -45);
    REQUIRE(result.envelope_lag_us);
    CHECK(std::abs(*result.envelope_lag_us) < 15);
  }
}

TEST_CASE("an envelope that is not the commanded one is refused or flagged, with its lag",
          "[sensing][follow]") {
  Room room;
  SECTION("it does not follow at all") {
    const auto result = room.judged(texture, [](auto) { return 0.5; });
    CHECK(result.verdict == Proof::refused);
    CHECK(result.envelope_error_dB.value() > -12);
  }
  SECTION("it follows late") {
    room.played_late = 96;
    auto result = room.judged(texture);
    CHECK(result.verdict == Proof::flagged);
    CHECK(result.cause == ProofCause::late);
    CHECK(result.envelope_lag_us.value() == Approx(500).margin(40));
    room.played_late = 240;
    result = room.judged(texture);
    CHECK(result.verdict == Proof::refused);
    CHECK(result.envelope_lag_us.value() == Approx(1250).margin(60));
  }
  SECTION("it follows half") {
    const auto result = room.judged(texture, [](std::int64_t n) { return 0.25 + 0.5 * texture(n); });
    CHECK(result.verdict != Proof::ok);
    CHECK(result.envelope_error_dB.value() > -20);
  }
  SECTION("its level is wrong") {
    room.scale = 0.5;
    const auto result = room.judged(texture);
    CHECK(result.verdict == Proof::stopped);
    CHECK(result.cause == ProofCause::level);
    CHECK(result.ratio_dB == Approx(-6.02).margin(0.1));
  }
  SECTION("the plate does not move") {
    room.scale = 0;
    const auto result = room.judged(texture);
    CHECK(result.verdict == Proof::stopped);
    CHECK(result.cause == ProofCause::dead);
  }
  SECTION("captured frames are lost") {
    room.lost_at = 50400;
    const auto result = room.judged(texture);
    CHECK(result.verdict == Proof::lost);
    CHECK(result.cause == ProofCause::gap);
    CHECK(result.lost_frames > 0);
  }
}

TEST_CASE("of 240 faultless bursts of weak to strong modulation, under a finger, none is flagged as late",
          "[sensing][follow]") {
  std::mt19937_64 random(5);
  int beyond = 0, stated = 0, late = 0;
  for (int k = 0; k < 240; ++k) {
    Room room;
    room.length = 38400;
    // The finger's damping varies with its force: slowly, by 3 %.
    room.finger = waves(random, 0.03, 1, 15);
    const double depth = std::exp(std::uniform_real_distribution(std::log(0.003), std::log(0.3))(random));
    const double fastest_Hz =
        std::exp(std::uniform_real_distribution(std::log(5.0), std::log(200.0))(random));
    const auto wave = waves(random, depth, 1, fastest_Hz);
    const auto result = room.judged([&](std::int64_t n) { return 0.5 * wave(n); });
    stated += result.envelope_lag_us ? 1 : 0;
    beyond += result.envelope_lag_us && std::abs(*result.envelope_lag_us) >= 300 ? 1 : 0;
    late += result.cause == ProofCause::late ? 1 : 0;
  }
  CAPTURE(beyond, stated);
  CHECK(late == 0);
  CHECK(stated > 20);
}

TEST_CASE("under the same finger, a strong modulation that is 500 us late is always flagged",
          "[sensing][follow]") {
  std::mt19937_64 random(6);
  int late = 0;
  for (int k = 0; k < 20; ++k) {
    Room room;
    room.finger = waves(random, 0.03, 1, 15);
    room.played_late = 96;
    const auto wave = waves(random, 0.3, 20, 80);
    const auto result = room.judged([&](std::int64_t n) { return 0.5 * wave(n); });
    late += result.envelope_lag_us && *result.envelope_lag_us > 400 && result.verdict != Proof::ok ? 1 : 0;
  }
  CHECK(late == 20);
}

TEST_CASE(
    "times at which the played gain is not known are not judged, and too little leaves a burst unproven",
    "[sensing][follow]") {
  const auto unknown_from = [](std::int64_t from) {
    return [from](std::int64_t n) { return n >= from && n < kStart + 80000 ? std::nan("") : texture(n); };
  };
  // in the unknown times something else is played
  const auto other = [](std::int64_t from) {
    return [from](std::int64_t n) { return n >= from + 100 && n < kStart + 79000 ? 0.0 : texture(n); };
  };
  CHECK(Room{}.judged(unknown_from(50000), other(50000)).verdict == Proof::ok);
  CHECK(Room{}.judged(texture, other(50000)).verdict == Proof::stopped);  // negative control
  CHECK(Room{}.judged([](auto) { return std::nan(""); }, texture).verdict == Proof::unproven);
  CHECK(Room{}.judged([](auto) { return 0.001; }).verdict == Proof::unproven);  // nothing to see
}
