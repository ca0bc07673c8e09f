#include <cmath>
#include <limits>

#include "station/audio/prepared_burst.hpp"
#include "station/audio/sine.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

TEST_CASE("the polynomial sine agrees with libm within rounding at every kind of phase", "[drive][sine]") {
  double worst = 0;
  std::uint64_t phase = 0;
  for (int k = 0; k < 400000; ++k, phase += 0x3243f6a8885a308du) {
    const double angle =
        2 * M_PI * std::ldexp(static_cast<double>(static_cast<std::int64_t>(phase) >> 11), -53);
    worst = std::max(worst, std::abs(sine_of_phase(phase) - std::sin(angle)));
  }
  CHECK(worst < 1.5e-15);  // the rounded argument of std::sin alone causes an error of 4e-16
  CHECK(sine_of_phase(0) == Approx(0).margin(1e-300));
  CHECK(sine_of_phase(quarter_cycle) == Approx(1).epsilon(1e-15));
  CHECK(sine_of_phase(3 * quarter_cycle) == Approx(-1).epsilon(1e-15));
}

TEST_CASE("phase increments are correctly rounded fractions of the sample rate", "[drive][sine]") {
  CHECK(phase_increment(48000, 192000) == quarter_cycle);
  CHECK(phase_increment(0.75, 192000) == 0x4189374bc6a8u);  // 0.75 / 192000 * 2^64 = 72057594037927.936
  CHECK(phase_increment(19600, 192000) == 0x1a22222222222222u);
  CHECK(phase_increment(1e-30, 192000) == 0);
}

TEST_CASE("a burst outside the limits is refused with the reason instead of being clipped",
          "[drive][burst]") {
  const Format format;
  CHECK_NOTHROW(prepare(one_tone(20000, 0.9), format));
  CHECK_THROWS_AS(prepare(one_tone(86400, 0.5), format), BurstRefused);
  CHECK_NOTHROW(prepare(one_tone(86399, 0.5), format));
  CHECK_THROWS_AS(prepare(one_tone(0, 0.5), format), BurstRefused);
  CHECK_THROWS_AS(prepare(one_tone(20000, -0.1), format), BurstRefused);
  CHECK_THROWS_AS(prepare(one_tone(20000, 1.0), format), BurstRefused);
  CHECK_THROWS_AS(prepare(one_tone(std::numeric_limits<double>::quiet_NaN(), 0.5), format), BurstRefused);
  Burst burst = one_tone(20000, 0.5);
  burst.tones.tones[0].channel = 2;
  CHECK_THROWS_WITH(prepare(burst, format),
                    "burst refused: tone on channel 2; the output has only channels 0 to 1");
  burst = one_tone(20000, 0.5);
  burst.ramp.frames = burst.length_frames / 2 + 1;
  CHECK_THROWS_AS(prepare(burst, format), BurstRefused);
  burst = one_tone(20000, 0.5);
  burst.signal = {1, 0.2, 1000, burst.length_frames - 9600, 9600};
  CHECK_NOTHROW(prepare(burst, format));
  ++burst.signal.at_frame;
  CHECK_THROWS_WITH(prepare(burst, format), Catch::Matchers::ContainsSubstring("it must lie within the burst's"));
  burst.signal = {0, 0.6, 1000, 0, 9600};  // on the tone's own channel, above full scale
  CHECK_THROWS_AS(prepare(burst, format), BurstRefused);
}

TEST_CASE(
    "tones whose amplitudes add up to more than full scale are accepted if the sum of their samples stays "
    "below",
    "[drive][burst]") {
  Burst burst = one_tone(20000, 0.6);
  burst.tones.tones[1] = {60000, 0.6, 0, 0};  // in phase with 20 kHz, the third harmonic flattens the sum
  burst.tones.count = 2;
  const PreparedBurst flat = prepare(burst, Format{});
  CHECK(flat.peak[0] < 0.98);
  CHECK(flat.peak[0] > 0.90);
  burst.tones.tones[1].phase_rad = M_PI;  // now the harmonic raises the peaks of the sum
  CHECK_THROWS_AS(prepare(burst, Format{}), BurstRefused);
}

TEST_CASE("live changes must be in ascending order, lie inside the burst, and leave each tone on its channel",
          "[drive][burst]") {
  Burst burst = one_tone(20000, 0.5);
  burst.change_count = 1;
  burst.changes[0] = {20000, 9600, one_tone(21000, 0.4).tones};
  CHECK_NOTHROW(prepare(burst, Format{}));
  burst.changes[0].at_frame = burst.length_frames - 100;
  CHECK_THROWS_AS(prepare(burst, Format{}), BurstRefused);
  burst.changes[0].at_frame = 20000;
  burst.changes[0].to.tones[0].channel = 1;
  CHECK_THROWS_AS(prepare(burst, Format{}), BurstRefused);
}
