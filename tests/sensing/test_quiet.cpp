// Demodulation must not allocate memory, because it may run on a thread with real-time priority.
#include "station/sensing/carrier.hpp"
#include "tests/audio/watch.hpp"
#include "tests/sensing/bridge_signal.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

TEST_CASE("demodulating bridges allocates nothing", "[sensing]") {
  BridgeSignal signal;
  const auto samples = signal.frames(0, 20000);
  BridgeDemodulator demodulator(bridge_options());
  double sum = 0;
  const auto take = [&](const BridgePoint& point) { sum += point.reference; };
  CHECK(turnpoint::audio::violations_in([&] {
          demodulator.push({samples, 4, 0}, take);
          demodulator.push({samples, 4, 30000}, take);
        }) == 0);
  CHECK(turnpoint::audio::violations_in([] { delete new BridgeDemodulator(bridge_options()); }) > 0);
}
