#include <stdexcept>

#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::simulation;

namespace {

/// A laboratory with every feature: noise, crosstalk, a finger, two transducers, a marker, and a delay with a
/// fraction of a frame.
Setup whole_laboratory() {
  Setup setup;
  setup.surface = quiet_setup().surface;
  setup.transducers = {{0, 4.0}, {1, 3.0}};
  setup.marker_channel = 2;
  setup.cells.height_m = 0.008;
  setup.finger.touches = {{500}};
  setup.finger.stroke_s = 0.3;
  setup.finger.pause_s = 0.01;
  setup.loop_delay_frames = 800.37;
  return setup;
}

double everything(std::int64_t n, int channel) {
  switch (channel) {
    case 0:
      return 0.4 * cosine(30e3, n);
    case 1:
      return n % 5000 < 2500 ? 0.4 * cosine(36e3, n) : 0;
    case 2:
      return static_cast<double>(n) * 0x1p-23;
    default:
      return 0.9 * cosine(kCarrier_Hz, n);
  }
}

Recording record(const Setup& setup, std::int64_t block, std::int64_t frames = 48000) {
  Plant plant(setup);
  plant.set_tones({30e3, 36e3});
  plant.add({FaultKind::transducer_half, 10001, 20003});
  plant.add({FaultKind::frequency_off, 12007, 16001});
  plant.add({FaultKind::gap, 14003, kNever, 333});
  plant.add({FaultKind::warmer, 24001, 30011});
  plant.add({FaultKind::drive_late, 31013});
  plant.add({FaultKind::finger_lifts, 33017, 36019});
  return run(plant, frames, everything, block);
}

}  // namespace

TEST_CASE("what is captured does not depend on the size of the blocks", "[plant]") {
  const auto setup = whole_laboratory();
  const auto reference = record(setup, 48000);
  for (const std::int64_t block : {1, 7, 192, 1000, 4096}) {
    CAPTURE(block);
    CHECK((record(setup, block).samples == reference.samples));
  }
}

TEST_CASE("the seed determines all noise", "[plant]") {
  auto setup = whole_laboratory();
  const auto first = record(setup, 960, 9600);
  CHECK((record(setup, 960, 9600).samples == first.samples));
  setup.seed = 2;
  const auto second = record(setup, 960, 9600);
  for (const int channel : {kReference, kBridgeA, kBridgeB, kLateral, kPickup, kPickup + 1}) {
    int different = 0;
    for (std::int64_t n = 0; n < 9600; ++n) different += first.at(n, channel) != second.at(n, channel);
    CAPTURE(channel);
    CHECK(different > 9000);
  }
  for (std::int64_t n = 0; n < 9600; ++n) REQUIRE(first.at(n, kMarker) == second.at(n, kMarker));
}

TEST_CASE("the bridges carry the readings that the truth states", "[plant]") {
  Setup setup = quiet_setup();
  setup.finger.touches = {{}};
  setup.cells.height_m = 0.008;
  setup.loop_delay_frames = 0;
  Plant plant(setup);
  // with a constant excitation, each captured sample is the reading of a bridge
  const auto direct = [](std::int64_t, int channel) { return channel == 3 ? 1.0 : 0.0; };
  for (int k = 0; k < 200; ++k) {
    const auto recording = run(plant, 961, direct);
    const auto& truth = plant.truth();
    REQUIRE(truth.frame == recording.end() - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const double reading_N = recording.at(truth.frame, kBridgeA + static_cast<int>(c)) * 2.1 / 200 / 0.5e-3;
      REQUIRE(reading_N == Approx(truth.reading_N[c]).margin(3e-6));
    }
  }
  // the finger moves so slowly, compared with the cells' resonances, that the readings follow its forces
  CHECK(plant.truth().finger.speed_m_s > 0.05);
  CHECK(plant.truth().normal_N == Approx(0.5).epsilon(1e-9));
  CHECK(plant.truth().lateral_N == Approx(0.4).epsilon(1e-9));
  CHECK(plant.truth().reading_N[0] + plant.truth().reading_N[1] == Approx(0.5).epsilon(1e-3));
  const double centre_m = 0.3 * plant.truth().reading_N[1] / 0.5;
  CHECK(centre_m == Approx(plant.truth().finger.contact_m + 0.008 * 0.8).margin(2e-4));
}

TEST_CASE("a setup that cannot work is refused", "[plant]") {
  const auto refused = [](auto change) {
    Setup setup = quiet_setup();
    change(setup);
    CHECK_THROWS_AS(Plant(setup), std::invalid_argument);
  };
  refused([](Setup& s) { s.transducers[0].channel = 4; });
  refused([](Setup& s) { s.wires.carrier_channel = -1; });
  refused([](Setup& s) { s.capture.bridge_a = 8; });
  refused([](Setup& s) { s.capture.bridge_a = 0; });
  refused([](Setup& s) { s.loop_delay_frames = -1; });
  refused([](Setup& s) { s.loop_delay_frames = 23.5; });
  refused([](Setup& s) { s.surface.quality_factor = std::numeric_limits<double>::infinity(); });
  Plant plant(quiet_setup());
  std::vector<double> played(40), captured(79);
  CHECK_THROWS_AS(plant.advance(played, captured), std::invalid_argument);
  CHECK_THROWS_AS(plant.add({FaultKind::transducer_dead, 0, kNever, {}, 1}), std::invalid_argument);
  CHECK_THROWS_AS(plant.add({FaultKind::gap, 0, kNever, 401}), std::invalid_argument);
  CHECK_THROWS_AS(plant.add({FaultKind::drive_late, 0, kNever, 1.1}), std::invalid_argument);
  CHECK_THROWS_AS(plant.add({FaultKind::drive_late, 0, kNever, -0.1}), std::invalid_argument);
  CHECK_THROWS_AS(plant.add({FaultKind::resonance_off, 0, kNever, 0.9}), std::invalid_argument);
  CHECK_THROWS_AS(plant.add({FaultKind::broken_bridge, 0, kNever, {}, 3}), std::invalid_argument);
  captured.push_back(0);
  plant.advance(played, captured);
  CHECK_THROWS_AS(plant.add({FaultKind::clip, 9}), std::invalid_argument);
  CHECK_NOTHROW(plant.add({FaultKind::clip, 10}));
}
