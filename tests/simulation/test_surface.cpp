#include "physics/field.hpp"
#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::simulation;
namespace physics = turnpoint::physics;

namespace {

std::complex<double> model(const physics::Surface& surface, double frequency_Hz, double x_m) {
  const physics::Tone tone{frequency_Hz, 1, 0};
  return physics::evaluate_tones(surface, {&tone, 1}, {&x_m, 1}, physics::Model::mode,
                                 physics::Normalise::none)[0]
      .v[0];
}

auto tone_on_drive(double frequency_Hz, double full_scale) {
  return [=](std::int64_t n, int channel) { return channel == 0 ? full_scale * cosine(frequency_Hz, n) : 0; };
}

/// Returns the position beyond the last maximum of the gain at which the gain has fallen to half of that
/// maximum.
double half_gain_m(const Plant& plant) {
  double x = 0.299;
  while (plant.gain_at(0, x - 1e-4) < 1e-2 || plant.gain_at(0, x - 1e-4) > plant.gain_at(0, x)) x -= 1e-4;
  const double half = plant.gain_at(0, x) / 2;
  double out = x + 0.05, in = x;
  for (int k = 0; k < 50; ++k) (plant.gain_at(0, (in + out) / 2) > half ? in : out) = (in + out) / 2;
  return in;
}

}  // namespace

TEST_CASE("a pick-up at the drive edge gives displacement times sensitivity", "[plant]") {
  Setup setup = quiet_setup();
  setup.transducers = {{0, 4.0}, {1, 2.0}};
  setup.pickups = {{5, 0, 0.07, 0}};
  Plant plant(setup);
  const auto recording = run(plant, 38400, [](std::int64_t n, int channel) {
    return channel == 0 ? 0.25 * cosine(30e3, n) : channel == 1 ? 0.4 * cosine(35e3, n) : 0;
  });
  const auto first = without_delay(amplitude(recording, kPickup, 30e3, 19200, 38400), 30e3, 400);
  const auto second = without_delay(amplitude(recording, kPickup, 35e3, 19200, 38400), 35e3, 400);
  CHECK(std::abs(first - 0.25 * 4.0 * 0.07) < 1e-7);
  CHECK(std::abs(second - 0.4 * 2.0 * 0.07) < 1e-7);
}

TEST_CASE("pick-ups inside of the drive edge have the response of the surface", "[plant]") {
  Plant plant(quiet_setup());
  CHECK(plant.pickup_error() < 0.04);
  for (const double f : {22.4e3, 26e3, 30.1e3, 33.7e3, 41e3, 45e3})
    for (const int k : {0, 1}) {
      CAPTURE(f, k);
      const auto wanted = model(plant.setup().surface, f, k == 0 ? 0.003 : 0.009);
      CHECK(std::abs(plant.pickup_response(static_cast<std::size_t>(k), f) - wanted) < 0.015);
    }
}

TEST_CASE("what a pick-up captures is its response times the drive", "[plant]") {
  Plant plant(quiet_setup());
  const auto recording = run(plant, 38400, tone_on_drive(31234.5, 0.5));
  for (const int k : {0, 1}) {
    const auto z = without_delay(amplitude(recording, kPickup + k, 31234.5, 19200, 38400), 31234.5, 400);
    CHECK(std::abs(z - 0.5 * 4 * 0.1 * plant.pickup_response(static_cast<std::size_t>(k), 31234.5)) < 1e-6);
  }
}

TEST_CASE("a pick-up's resonances are those of the surface, with its loss", "[plant]") {
  // After the drive ends, the motion decays like exp(-pi f t / Q).
  Setup setup = quiet_setup();
  setup.surface.quality_factor = 200;
  setup.pickups = {{5, 0.009, 0.1, 0}};
  Plant slow(setup);
  setup.surface.quality_factor = 60;
  Plant fast(setup);
  const double f = physics::tone_info(setup.surface, 31e3).nearest_resonance_Hz.value();
  const auto play = [&](std::int64_t n, int channel) {
    return channel == 0 && n < 38400 ? 0.2 * cosine(f, n) : 0;
  };
  const auto left = [&](Plant& plant) {
    const auto recording = run(plant, 40400, play);
    const std::int64_t end = 38400 + 400;
    return std::abs(amplitude(recording, kPickup, f, end + 196, end + 388)) /
           std::abs(amplitude(recording, kPickup, f, end + 4, end + 196));
  };
  CHECK(std::log(left(slow)) == Approx(-pi * f / 200 * 1e-3).epsilon(0.15));
  CHECK(std::log(left(fast)) == Approx(-pi * f / 60 * 1e-3).epsilon(0.15));
}

TEST_CASE("the finger feels the rms of the model's displacement over the fingertip", "[plant]") {
  Plant plant(quiet_setup());
  plant.set_tones({30e3, 38e3});
  for (const double x : {0.05, 0.1, 0.13, 0.15})
    for (const std::size_t tone : {0u, 1u}) {
      double sum = 0;
      for (int k = 0; k < 200; ++k)
        sum += std::norm(
            model(plant.setup().surface, tone == 0 ? 30e3 : 38e3, x - 0.005 + 0.01 * (k + 0.5) / 200));
      CAPTURE(x, tone);
      CHECK(plant.gain_at(tone, x) == Approx(std::sqrt(sum / 200)).epsilon(2e-3));
    }
}

TEST_CASE("the finger's friction is the mean over the fingertip of the friction below each part", "[plant]") {
  double largest = 0;
  for (const double x : {0.05, 0.1, 0.13, 0.15, 0.155}) {
    Setup setup = quiet_setup();
    setup.finger.touches = {{}};
    setup.finger.to_m = setup.finger.from_m = x;
    Plant plant(setup);
    plant.set_tones({30e3});
    run(plant, 3 * 19200,
        [](std::int64_t n, int channel) { return channel == 0 ? 0.2 * cosine(30e3, n) : 0; });
    double mean = 0, square = 0;
    for (int k = 0; k < 200; ++k) {
      const auto v = model(setup.surface, 30e3, x - 0.005 + 0.01 * (k + 0.5) / 200);
      mean += setup.friction.relative_friction(0.8e-6 * std::abs(v)) / 200;
      square += std::norm(v) / 200;
    }
    CAPTURE(x);
    CHECK(plant.truth().finger.relative_friction == Approx(mean).epsilon(5e-3));
    const double of_rms = setup.friction.relative_friction(0.8e-6 * std::sqrt(square));
    largest = std::max(largest, std::abs(mean - of_rms));
  }
  // negative control: the friction of the mean displacement would be clearly different
  CHECK(largest > 0.015);
}

TEST_CASE("the amplitudes of tones under the finger add as squares, and follow what was played", "[plant]") {
  Setup setup = quiet_setup();
  setup.finger.touches = {{}};
  setup.finger.to_m = setup.finger.from_m = 0.1;
  Plant plant(setup);
  plant.set_tones({30e3, 31050});
  run(plant, 3 * 19200, [](std::int64_t n, int channel) {
    return channel == 0 ? 0.2 * cosine(30e3, n) + 0.3 * cosine(31050, n) : 0;
  });
  CHECK(std::abs(plant.tone_um(0)) == Approx(0.8).epsilon(2e-3));
  CHECK(std::abs(plant.tone_um(1)) == Approx(1.2).epsilon(2e-3));
  // the tone is played with phase 0 and reaches the surface 400 frames later
  CHECK(std::abs(without_delay(plant.tone_um(0), 30e3, 400) - 0.8) < 3e-3);
  const double felt = std::hypot(0.8 * plant.gain_at(0, 0.1), 1.2 * plant.gain_at(1, 0.1));
  CHECK(plant.truth().amplitude_um == Approx(felt).epsilon(2e-3));
  run(plant, 19200, silence);
  CHECK(plant.truth().amplitude_um < 1e-9);
}

TEST_CASE("named tones are followed without a break when others come and go", "[plant]") {
  Plant plant(quiet_setup());
  plant.set_tones({30e3});
  run(plant, 9600 + 100, tone_on_drive(30e3, 0.5));
  plant.set_tones({28e3, 30e3, 40e3});
  run(plant, 30, tone_on_drive(30e3, 0.5));
  CHECK(std::abs(plant.tone_um(1)) == Approx(2).epsilon(1e-3));
  run(plant, 9600, tone_on_drive(30e3, 0.5));
  CHECK(std::abs(plant.tone_um(1)) == Approx(2).epsilon(1e-3));
  CHECK(std::abs(plant.tone_um(0)) < 2e-3);
  CHECK(std::abs(plant.tone_um(2)) < 2e-3);
}

TEST_CASE("warmth moves the boundary outward by the closed form", "[plant]") {
  Setup setup = quiet_setup();
  setup.finger.fingertip_m = 1e-3;
  for (const double f : {22.4e3, 30e3, 45e3}) {
    Plant cold(setup);
    setup.temperature_C = 33;
    Plant warm(setup);
    setup.temperature_C = 23;
    cold.set_tones({f});
    warm.set_tones({f});
    // Expected shift of the boundary: (half-width of the strip at the boundary / slope of the taper) times
    // (relative change of Young's modulus plus that of lengths, per kelvin) / 4 times 10 K.
    const double x = half_gain_m(cold);
    const double width_m = 0.014 - 0.03 * x;
    const double shift_m = width_m / 0.03 * (4.8e-4 - 2.3e-5) / 4 * 10;
    CAPTURE(f, x);
    CHECK(half_gain_m(warm) - x == Approx(shift_m).epsilon(0.06));
  }
}

TEST_CASE("warmth lowers the pick-ups' resonances by the closed form", "[plant]") {
  Setup setup = quiet_setup();
  Plant cold(setup);
  setup.temperature_C = 33;
  Plant warm(setup);
  const double scale = 1 - (4.8e-4 - 2.3e-5) / 2 * 10;
  for (const double f : {25e3, 31e3, 31.5e3, 44e3}) {
    CAPTURE(f);
    CHECK(std::abs(warm.pickup_response(0, f * scale) - cold.pickup_response(0, f)) < 2e-3);
    CHECK(std::abs(warm.pickup_response(1, f * scale) - cold.pickup_response(1, f)) < 2e-3);
  }
}

TEST_CASE("a surface that nothing drives comes to rest, instead of moving by the smallest numbers for ever",
          "[plant]") {
  const Setup setup = quiet_setup();
  const std::vector<double> x_m{0.003, 0.009};
  PickupFilter filter(surface_response(setup.surface, x_m, setup.band_low_Hz, setup.band_high_Hz), kRate_Hz,
                      1);
  for (std::int64_t n = 0; n < 1000; ++n) filter.step(cosine(31e3, n));
  CHECK(filter.output(0) != 0);
  for (int n = 0; n < 192000; ++n) filter.step(0);
  CHECK(filter.output(0) == 0);
  CHECK(filter.output(1) == 0);
}
