// Counts memory allocations while the plant advances.
#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/count_allocations.hpp"

using namespace turnpoint::simulation;

TEST_CASE("advancing allocates no memory, whatever fails", "[plant]") {
  Setup setup;
  setup.surface = quiet_setup().surface;
  setup.marker_channel = 2;
  setup.finger.touches = {{0, 3000}, {5000, kNever}};
  setup.loop_delay_frames = 800.37;
  Plant plant(setup);
  plant.set_tones({30e3, 36e3});
  std::int64_t from = 1000;
  for (const auto kind : {FaultKind::transducer_dead, FaultKind::transducer_half, FaultKind::resonance_off,
                          FaultKind::frequency_off, FaultKind::drive_late, FaultKind::clip,
                          FaultKind::broken_bridge, FaultKind::no_reference, FaultKind::finger_lifts,
                          FaultKind::gap, FaultKind::warmer, FaultKind::sounding}) {
    plant.add({kind, from, from + 2500});
    from += 1000;
  }
  std::vector<double> played(4 * 20000), captured(8 * 20000);
  for (std::size_t n = 0; n < 20000; ++n) played[4 * n] = 0.5 * cosine(30e3, static_cast<std::int64_t>(n));
  const long before = allocations;
  plant.advance(played, captured);
  CHECK(allocations == before);
  CHECK(plant.frames() == 20000);
  const std::vector<double> counted(1000);
  CHECK(allocations > before);
}
