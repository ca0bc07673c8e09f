#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::simulation;

namespace {

constexpr std::int64_t kDelay = 400, kAt = 38400, kEnd = 76800;

double tone_and_carrier(std::int64_t n, int channel) {
  return channel == 0 ? 0.8 * cosine(30e3, n) : channel == 3 ? cosine(kCarrier_Hz, n) : 0;
}

/// Plays a tone and the carrier. `fault` should begin in the middle, at frame kAt.
struct Trial {
  explicit Trial(const Fault& fault, const Setup& setup = quiet_setup()) : plant(setup) {
    plant.set_tones({30e3});
    plant.add(fault);
    recording = run(plant, kEnd, tone_and_carrier);
  }
  double before(int channel, double frequency_Hz) const {
    return std::abs(amplitude(recording, channel, frequency_Hz, kAt - 19200, kAt));
  }
  double after(int channel, double frequency_Hz) const {
    return std::abs(amplitude(recording, channel, frequency_Hz, kEnd - 19200, kEnd));
  }
  double change_dB(int channel, double frequency_Hz) const {
    return 20 * std::log10(after(channel, frequency_Hz) / before(channel, frequency_Hz));
  }

  Plant plant;
  Recording recording{};
};

}  // namespace

TEST_CASE("each kind of fault has a name", "[plant]") {
  CHECK(name(FaultKind::transducer_dead) == "transducer dead");
  CHECK(name(FaultKind::broken_bridge) == "broken bridge");
  CHECK(name(FaultKind::warmer) == "warmer");
  CHECK(name(FaultKind::dead_bridge) == "dead bridge");
  for (int k = 0; k <= static_cast<int>(FaultKind::dead_bridge); ++k)
    CHECK(find_fault(name(static_cast<FaultKind>(k))) == static_cast<FaultKind>(k));
  CHECK_FALSE(find_fault("dead"));
}

TEST_CASE("without a fault nothing changes", "[plant]") {
  const Trial trial({FaultKind::transducer_dead, kEnd + 1});
  CHECK(std::abs(trial.change_dB(kPickup, 30e3)) < 1e-4);
  CHECK(std::abs(trial.change_dB(kReference, kCarrier_Hz)) < 1e-4);
}

TEST_CASE("a dead transducer moves nothing", "[plant]") {
  const Trial trial({FaultKind::transducer_dead, kAt});
  CHECK(trial.before(kPickup, 30e3) > 0.1);
  CHECK(trial.after(kPickup, 30e3) < 1e-7);
  CHECK(trial.plant.truth().drive_um == 0);
  CHECK(std::abs(trial.plant.tone_um(0)) < 1e-9);
}

TEST_CASE("one dead transducer of two leaves the other", "[plant]") {
  Setup setup = quiet_setup();
  setup.transducers = {{0, 3.0}, {0, 1.0}};
  CHECK(Trial({FaultKind::transducer_dead, kAt, kNever, {}, 0}, setup).change_dB(kPickup, 30e3) ==
        Approx(-12.04).margin(0.01));
  CHECK(Trial({FaultKind::transducer_dead, kAt, kNever, {}, 1}, setup).change_dB(kPickup, 30e3) ==
        Approx(-2.50).margin(0.01));
}

TEST_CASE("half of a transducer gives 6 dB less", "[plant]") {
  const Trial trial({FaultKind::transducer_half, kAt});
  CHECK(trial.change_dB(kPickup, 30e3) == Approx(-6.0206).margin(1e-3));
  CHECK(trial.change_dB(kPickup + 1, 30e3) == Approx(-6.0206).margin(1e-3));
}

TEST_CASE("a fault can end", "[plant]") {
  const Trial trial({FaultKind::transducer_dead, kAt, kAt + 9600});
  CHECK(std::abs(amplitude(trial.recording, kPickup, 30e3, kAt + 4800, kAt + 9600)) < 1e-7);
  CHECK(std::abs(trial.change_dB(kPickup, 30e3)) < 1e-3);
}

TEST_CASE("resonances that are 3 % higher change a pick-up as a tone 3 % lower would", "[plant]") {
  Plant healthy(quiet_setup());
  const Trial trial({FaultKind::resonance_off, kAt});
  const auto shifted = healthy.pickup_response(1, 30e3 / 1.03);
  CHECK(std::abs(trial.plant.pickup_response(1, 30e3) - shifted) < 0.02);
  CHECK(trial.after(kPickup + 1, 30e3) ==
        Approx(0.8 * 4 * 0.1 * std::abs(trial.plant.pickup_response(1, 30e3))).epsilon(1e-4));
  healthy.set_tones({30e3 / 1.03});
  for (const double x : {0.05, 0.1, 0.14}) CHECK(trial.plant.gain_at(0, x) == healthy.gain_at(0, x));
  CHECK(std::abs(trial.change_dB(kPickup + 1, 30e3)) > 0.5);
}

TEST_CASE("the surface continues its motion while its resonances change", "[plant]") {
  // A change of 1 mK is too small to be seen, so the recording must continue as without a fault.
  Plant healthy(quiet_setup());
  const auto expected = run(healthy, kAt + 2000, tone_and_carrier);
  Plant plant(quiet_setup());
  plant.add({FaultKind::warmer, kAt, kNever, 1e-3});
  const auto recording = run(plant, kAt + 2000, tone_and_carrier);
  bool different = false;
  for (std::int64_t n = kAt; n < kAt + 2000; ++n) {
    REQUIRE(std::abs(recording.at(n, kPickup + 1) - expected.at(n, kPickup + 1)) < 2e-5);
    different = different || recording.at(n, kPickup + 1) != expected.at(n, kPickup + 1);
  }
  CHECK(different);
}

TEST_CASE("a frequency that is 3 % off appears at the pick-ups instead of the played one", "[plant]") {
  const Trial trial({FaultKind::frequency_off, kAt});
  CHECK(trial.after(kPickup, 30e3) < 1e-4);
  CHECK(trial.before(kPickup, 30.9e3) < 1e-4);
  CHECK(trial.after(kPickup, 30.9e3) ==
        Approx(0.8 * 4 * 0.1 * std::abs(trial.plant.pickup_response(0, 30.9e3))).epsilon(1e-3));
}

TEST_CASE("a late drive comes 5 ms later, and the carrier does not", "[plant]") {
  Setup setup = quiet_setup();
  setup.pickups = {{5, 0, 0.1, 0}};
  const auto first = [&](bool late) {
    Plant plant(setup);
    if (late) plant.add({FaultKind::drive_late});
    const auto recording = run(plant, 4000, [](std::int64_t n, int) { return n < 1000 ? 0 : 0.5; });
    std::int64_t pickup = 0, reference = 0;
    while (recording.at(pickup, kPickup) == 0) ++pickup;
    while (recording.at(reference, kReference) == 0) ++reference;
    return std::pair(pickup, reference);
  };
  CHECK(first(false) == std::pair(1000 + kDelay, 1000 + kDelay));
  CHECK(first(true) == std::pair(1000 + kDelay + 960, 1000 + kDelay));
}

TEST_CASE("a drive that sounds by itself moves the edge at its own frequency, beside what is played",
          "[plant]") {
  Setup setup = quiet_setup();
  setup.pickups = {{5, 0, 0.1, 0}};
  const Trial trial({FaultKind::sounding, kAt, kNever, 0.02}, setup);
  CHECK(trial.before(kPickup, 27e3) < 1e-7);
  CHECK(trial.after(kPickup, 27e3) == Approx(0.02 * 0.1).epsilon(1e-3));
  CHECK(std::abs(trial.change_dB(kPickup, 30e3)) < 1e-3);
}

TEST_CASE("clipping limits the drive and adds a third harmonic", "[plant]") {
  Setup setup = quiet_setup();
  setup.pickups = {{5, 0, 0.1, 0}};
  Plant plant(setup);
  plant.add({FaultKind::clip, kAt, kNever, 0.4});
  // 1.6 kHz divides the sampling rate, so the harmonics can be measured exactly
  const auto recording =
      run(plant, kEnd, [](std::int64_t n, int channel) { return channel == 0 ? 0.8 * cosine(1600, n) : 0; });
  double highest = 0;
  for (std::int64_t n = kAt; n < kEnd; ++n) highest = std::max(highest, std::abs(recording.at(n, kPickup)));
  CHECK(highest == Approx(0.4 * 4 * 0.1).margin(2e-7));
  // The fundamental in closed form for a cosine of amplitude 2 that is clipped at 1. It reaches 1 at 60
  // degrees.
  const double c = std::acos(0.5);
  const double harmonic1 = std::abs(amplitude(recording, kPickup, 1600, kAt + 9600, kEnd)) / (0.4 * 0.4);
  const double closed1 = 2 / pi * (2 * std::sin(c) + 2 * (pi / 2 - c) - std::sin(2 * c));
  CHECK(harmonic1 == Approx(closed1).epsilon(1e-3));
  CHECK(std::abs(amplitude(recording, kPickup, 4800, kAt + 9600, kEnd)) > 0.02);
  CHECK(std::abs(amplitude(recording, kPickup, 4800, 9600, kAt)) < 1e-6);
}

TEST_CASE("a broken bridge wire loses the force and brings the carrier a quarter period early", "[plant]") {
  for (const int cell : {0, 1, 2}) {
    Setup setup = quiet_setup();
    setup.cells.zero_N = {1, 1, 1};
    const Trial trial({FaultKind::broken_bridge, kAt, kNever, {}, cell}, setup);
    CAPTURE(cell);
    for (const int other : {0, 1, 2}) {
      if (other != cell) CHECK(std::abs(trial.change_dB(kBridgeA + other, kCarrier_Hz)) < 1e-4);
    }
    const auto open = amplitude(trial.recording, kBridgeA + cell, kCarrier_Hz, kEnd - 19200, kEnd);
    const auto reference = amplitude(trial.recording, kReference, kCarrier_Hz, kEnd - 19200, kEnd);
    const double w = 2 * pi * kCarrier_Hz;
    CHECK(std::abs(open) == Approx(1.2e-8 * w * 2.5 * 200 / 2.1).epsilon(0.01));
    // the plant takes the difference of two samples as the derivative, which lags by half a frame
    CHECK(std::arg(open / reference) == Approx(pi / 2 - w / 2 / kRate_Hz).epsilon(1e-3));
  }
}

TEST_CASE("without the reference its channel is silent, and the bridges go on", "[plant]") {
  Setup setup = quiet_setup();
  setup.cells.zero_N = {1, 1, 1};
  setup.wires.converter_noise_full_scale = 7e-6;
  const Trial trial({FaultKind::no_reference, kAt}, setup);
  CHECK(trial.before(kReference, kCarrier_Hz) == Approx(2.5 / 3).epsilon(1e-5));
  CHECK(trial.after(kReference, kCarrier_Hz) < 1e-6);
  CHECK(std::abs(trial.change_dB(kBridgeA, kCarrier_Hz)) < 1e-4);
}

TEST_CASE("a finger that lifts takes its forces away", "[plant]") {
  Setup setup = quiet_setup();
  setup.finger.touches = {{}};
  setup.finger.pause_s = 0;
  setup.finger.stroke_s = 0.5;
  Plant plant(setup);
  plant.add({FaultKind::finger_lifts, kAt, kEnd});
  run(plant, kAt, silence);
  CHECK(plant.truth().normal_N == Approx(0.5).epsilon(1e-9));
  CHECK(plant.truth().lateral_N == Approx(0.4).epsilon(1e-9));
  const double place_m = plant.truth().finger.finger_m;
  run(plant, 19200, silence);
  CHECK(plant.truth().normal_N == 0);
  CHECK(plant.truth().lateral_N == 0);
  CHECK(plant.truth().finger.finger_m > place_m);  // the hand continues its stroke in the air
  run(plant, 38400, silence);
  CHECK(plant.truth().normal_N == Approx(0.5).epsilon(1e-9));
}

TEST_CASE("a gap loses captured frames, and all later frames come earlier", "[plant]") {
  Setup setup = quiet_setup();
  setup.marker_channel = 2;
  setup.finger.touches = {{}};
  const auto play = [](std::int64_t n, int channel) {
    return channel == 2 ? static_cast<double>(n) * 0x1p-23 : tone_and_carrier(n, channel);
  };
  Plant whole(setup), broken(setup);
  broken.add({FaultKind::gap, 9601, kNever, 123});
  const auto expected = run(whole, 48000, play);
  const auto recording = run(broken, 48000 - 123, play);
  for (std::int64_t n = 0; n < recording.end(); ++n)
    for (const int channel : {kReference, kBridgeA, kLateral, kMarker, kPickup}) {
      CAPTURE(n, channel);
      REQUIRE(recording.at(n, channel) == expected.at(n < 9601 ? n : n + 123, channel));
    }
}

TEST_CASE("ten kelvin more shift zeros by 10 mN and resonances by half of the coefficients", "[plant]") {
  const Trial trial({FaultKind::warmer, kAt});
  Setup setup = quiet_setup();
  setup.temperature_C = 33;
  Plant warm(setup);
  CHECK(trial.plant.truth().temperature_C == 33);
  CHECK(trial.plant.pickup_response(1, 30e3) == warm.pickup_response(1, 30e3));
  CHECK(trial.before(kBridgeA, kCarrier_Hz) < 1e-7);
  CHECK(trial.after(kBridgeA, kCarrier_Hz) == Approx(0.010 * 0.5e-3 * 200 / 2.1).epsilon(0.01));
}
