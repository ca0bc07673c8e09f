#include "station/rig/rig.hpp"
#include "station/session/burst.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

audio::Burst one_second() {
  audio::Burst burst;
  burst.length_frames = 192000;
  return burst;
}

}  // namespace

TEST_CASE("a burst gets the rig's marker, which never lasts longer than the burst", "[session]") {
  rig::Marker marker;
  marker.channel = 1, marker.kind = rig::Marker::Kind::tone, marker.frequency_Hz = 5000,
  marker.duration_s = 2e-3;
  auto burst = one_second();
  session::mark(burst, marker, 192000);
  CHECK(burst.marker.kind == audio::MarkerKind::tone);
  CHECK(burst.marker.frames == 384);
  CHECK(burst.marker.frequency_Hz == 5000);
  marker.duration_s = 1.5;
  session::mark(burst, marker, 192000);
  CHECK(burst.marker.frames == burst.length_frames);
}

TEST_CASE("masking noise differs from interval to interval only in its seed", "[session]") {
  auto first = one_second(), second = first;
  session::mask(first, {1, 0.05, 200, 4000}, 7);
  session::mask(second, {1, 0.05, 200, 4000}, 8);
  CHECK(first.noise.rms == 0.05);
  CHECK(first.noise.low_Hz == 200);
  CHECK(first.noise.high_Hz == 4000);
  CHECK(first.noise.seed != second.noise.seed);
}
