#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::simulation;

namespace {

constexpr std::int64_t kSettled = 4 * 192000;  // time after which a step of force has decayed to 1e-15
constexpr std::int64_t kTenth = 19200;

/// Mean of the squared samples of a channel.
double mean_square(const Recording& recording, int channel) {
  double sum = 0;
  for (std::int64_t n = recording.first; n < recording.end(); ++n)
    sum += recording.at(n, channel) * recording.at(n, channel);
  return sum / static_cast<double>(recording.end() - recording.first);
}

}  // namespace

TEST_CASE("a known load gives a carrier of known amplitude on each bridge", "[plant]") {
  Setup setup = quiet_setup();
  setup.cells.height_m = 0.01;
  Plant plant(setup);
  plant.set_load({1.0, 0.4, 0.1});
  run(plant, kSettled, carrier);
  const auto recording = run(plant, kTenth, carrier);
  const auto a = amplitude(recording, kBridgeA, kCarrier_Hz, recording.first, recording.end());
  const auto b = amplitude(recording, kBridgeB, kCarrier_Hz, recording.first, recording.end());
  const auto t = amplitude(recording, kLateral, kCarrier_Hz, recording.first, recording.end());
  const auto reference = amplitude(recording, kReference, kCarrier_Hz, recording.first, recording.end());
  // 0.5 mV/N at 2.5 V, amplified 200 times, relative to a full scale of 2.1 V. Each cell carries its part of
  // the load, changed by h T / L (height, lateral force, distance of the cells).
  const double per_N = 0.5e-3 * 200 / 2.1;
  CHECK(std::abs(a) == Approx(per_N * (1.0 * 2 / 3 - 0.01 * 0.4 / 0.3)).epsilon(1e-6));
  CHECK(std::abs(b) == Approx(per_N * (1.0 / 3 + 0.01 * 0.4 / 0.3)).epsilon(1e-6));
  CHECK(std::abs(t) == Approx(per_N * 0.4).epsilon(1e-6));
  CHECK(std::abs(reference) == Approx(2.5 / 3.0).epsilon(1e-6));
  // apart from the delay of 400 frames, reference and bridges have the phase of the played carrier
  const auto at_playback = without_delay(reference, kCarrier_Hz, 400);
  CHECK(std::abs(std::arg(at_playback)) < 1e-6);
  CHECK(std::abs(std::arg(a / reference)) < 1e-5);
  CHECK(std::abs(std::arg(t / reference)) < 1e-5);
}

TEST_CASE("the amplitude of a bridge is proportional to the excitation that is played", "[plant]") {
  Plant plant(quiet_setup());
  plant.set_load({1.0, 0, 0.1});
  const auto half = [](std::int64_t frame, int channel) { return 0.5 * carrier(frame, channel); };
  run(plant, kSettled, half);
  const auto recording = run(plant, kTenth, half);
  CHECK(std::abs(amplitude(recording, kBridgeA, kCarrier_Hz, recording.first, recording.end())) ==
        Approx(0.5 * 0.5e-3 * 200 / 2.1 * 2 / 3).epsilon(2e-6));
}

TEST_CASE("the noise of a bridge is white, with the given density", "[plant]") {
  Setup setup = quiet_setup();
  setup.wires.noise_V_per_rtHz = 4e-9;
  Plant plant(setup);
  const auto recording = run(plant, 192000, silence);
  const double variance = std::pow(4e-9 * 200 / 2.1, 2) * 96000;
  for (const int channel : {kBridgeA, kBridgeB, kLateral}) {
    CAPTURE(channel);
    // the standard deviation of a variance from 192000 samples is 0.3 %
    CHECK(mean_square(recording, channel) == Approx(variance).epsilon(0.012));
    double neighbour = 0, next = 0;
    for (std::int64_t n = 1; n < recording.end(); ++n) {
      neighbour += recording.at(n, channel) * recording.at(n - 1, channel);
      next += recording.at(n, channel) * recording.at(n, 1 + channel % 3);
    }
    CHECK(std::abs(neighbour) < 4 * std::sqrt(192000.0) * variance);
    CHECK(std::abs(next) < 4 * std::sqrt(192000.0) * variance);  // the noise of the bridges is independent
  }
}

TEST_CASE("the density of a bridge's noise near the carrier is that of the whole band", "[plant]") {
  Setup setup = quiet_setup();
  setup.wires.noise_V_per_rtHz = 4e-9;
  Plant plant(setup);
  const auto recording = run(plant, 192000, silence);
  // Averages over 100 windows of 10 ms and 9 frequencies around the carrier. A Hann window of 10 ms has a
  // noise bandwidth of 150 Hz.
  double sum = 0;
  for (int part = 0; part < 100; ++part)
    for (int k = -4; k <= 4; ++k)
      sum += std::norm(amplitude(recording, kBridgeA, kCarrier_Hz + 300 * k, part * 1920, (part + 1) * 1920));
  // For white noise of variance s^2 and a window w of n frames, the mean of |z|^2 is 4 s^2 sum(w^2) /
  // sum(w)^2; for a Hann window that is 6 s^2 / n.
  const double variance = std::pow(4e-9 * 200 / 2.1, 2) * 96000;
  CHECK(sum / 900 == Approx(6 * variance / 1920).epsilon(0.15));
}

TEST_CASE("a tone of a quarter of full scale is 1 mV at each bridge", "[plant]") {
  Setup setup = quiet_setup();
  setup.wires.crosstalk_V_per_full_scale = 4e-3;
  Plant plant(setup);
  const auto recording = run(
      plant, kTenth, [](std::int64_t n, int channel) { return channel == 0 ? 0.25 * cosine(30e3, n) : 0; });
  CHECK(std::abs(amplitude(recording, kBridgeB, 30e3, 9600, kTenth)) ==
        Approx(1e-3 * 200 / 2.1).epsilon(1e-6));
}

TEST_CASE("distortion lets crosstalk change the carrier's amplitude", "[plant]") {
  Setup setup = quiet_setup();
  setup.wires.crosstalk_V_per_full_scale = 4e-3;
  setup.wires.a2_per_V = 2e-3;
  setup.wires.a3_per_V2 = 1e-3;
  setup.cells.span_m = 0.2;
  Plant plant(setup);
  plant.set_load({2.0, 0, 0.1});
  const auto play = [](std::int64_t n, int channel) {
    return channel == 3 ? cosine(kCarrier_Hz, n) : channel == 0 ? 0.8 * cosine(30e3, n) : 0;
  };
  run(plant, kSettled, play);
  const auto recording = run(plant, kTenth, play);
  // The sum y of two cosines with amplitudes S (the carrier) and A is distorted to y + a2 y^2 + a3 y^3. The
  // carrier's amplitude becomes S + a3 (3/4 S^3 + 3/2 S A^2), and a2 S A is at the sum and the difference of
  // both frequencies.
  const double s = 0.5e-3 * 200, a = 0.8 * 4e-3 * 200;
  const auto at = [&](double f) {
    return std::abs(amplitude(recording, kBridgeA, f, recording.first, recording.end())) * 2.1;
  };
  CHECK(at(kCarrier_Hz) == Approx(s + 1e-3 * (0.75 * s * s * s + 1.5 * s * a * a)).epsilon(1e-6));
  CHECK(at(30e3 - kCarrier_Hz) == Approx(2e-3 * s * a).epsilon(1e-4));
  CHECK(at(30e3 + kCarrier_Hz) == Approx(2e-3 * s * a).epsilon(1e-4));
}

TEST_CASE("captured samples are multiples of a 24-bit step and stay within full scale", "[plant]") {
  CHECK(converted(2.0, 24) == 1 - 0x1p-23);
  CHECK(converted(-2.0, 24) == -1);
  CHECK(converted(0x1.8p-23, 24) == 0x1p-22);
  CHECK(converted(0x1.6p-23, 24) == 0x1p-23);
  Setup setup;
  setup.surface = quiet_setup().surface;
  setup.finger.touches = {{}};
  setup.loop_delay_frames = 100.4;
  Plant plant(setup);
  plant.set_tones({30e3});
  const auto recording = run(plant, kTenth, [](std::int64_t n, int channel) {
    return channel == 3 ? 0.9 * cosine(kCarrier_Hz, n) : channel == 0 ? 0.5 * cosine(30e3, n) : 0;
  });
  bool different = false;
  for (const double sample : recording.samples) {
    const double steps = sample * 0x1p23;
    REQUIRE(steps == std::nearbyint(steps));
    REQUIRE(std::abs(sample) <= 1);
    different = different || std::fmod(steps, 4.0) != 0;
  }
  CHECK(different);
}

TEST_CASE("a played frame comes back after exactly the loop delay", "[plant]") {
  for (const double delay : {0.0, 7.0, 400.0}) {
    Setup setup = quiet_setup();
    setup.loop_delay_frames = delay;
    setup.marker_channel = 2;
    Plant plant(setup);
    const auto recording = run(plant, 2000, [](std::int64_t n, int channel) {
      return channel == 2 ? static_cast<double>(n) * 0x1p-23 : channel == 3 && n == 1000 ? 0.5 : 0;
    });
    CAPTURE(delay);
    const auto whole = static_cast<std::int64_t>(delay);
    for (std::int64_t n = 0; n < 2000; ++n) {
      REQUIRE(recording.at(n, kMarker) ==
              static_cast<double>(std::max<std::int64_t>(n - whole, 0)) * 0x1p-23);
      REQUIRE((recording.at(n, kReference) != 0) == (n == 1000 + whole));
    }
  }
}

TEST_CASE("a loop delay may be a fraction of a frame", "[plant]") {
  for (const double delay : {24.5, 400.05, 400.5, 400.93}) {
    Setup setup = quiet_setup();
    setup.loop_delay_frames = delay;
    setup.pickups = {{5, 0, 0.1, 0}};
    Plant plant(setup);
    CAPTURE(delay);
    const auto play = [](std::int64_t n, int channel) {
      return channel == 3 ? cosine(kCarrier_Hz, n) : channel == 0 ? 0.9 * cosine(45e3, n) : 0;
    };
    run(plant, kTenth, play);
    const auto recording = run(plant, kTenth, play);
    const auto carrier_back = without_delay(
        amplitude(recording, kReference, kCarrier_Hz, recording.first, recording.end()), kCarrier_Hz, delay);
    CHECK(std::abs(carrier_back - 2.5 / 3.0) < 1e-4);
    const auto tone_back =
        without_delay(amplitude(recording, kPickup, 45e3, recording.first, recording.end()), 45e3, delay);
    CHECK(std::abs(tone_back - 0.36) < 1e-4);
  }
}
