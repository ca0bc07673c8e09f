#include <cmath>

#include "station/audio/frame_clock.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

TEST_CASE("the regression finds the rate and offset of a clock with jitter, and states the residual",
          "[drive][clock]") {
  FrameClock clock(192000, 1000);
  const double ns_per_frame = 1e9 / 192000 * (1 + 37e-6);
  for (int k = 0; k < 3000; ++k) {
    const std::int64_t frame = 1'000'000'000'000 + 384 * k;
    const double jitter = 5000 * std::sin(1.7 * k * k);
    clock.add(frame, 77'000'000'000 + std::llround(384 * k * ns_per_frame + jitter));
  }
  const ClockFit fit = clock.fit();
  CHECK(fit.pairs == 1000);
  CHECK(fit.ns_per_frame == Approx(ns_per_frame).epsilon(1e-6));
  CHECK(fit.residual_ns == Approx(5000 / std::sqrt(2)).epsilon(0.1));
  const std::int64_t frame = 1'000'000'000'000 + 384 * 2999;
  CHECK(std::abs(static_cast<double>(fit.time_of(frame) - 77'000'000'000) - 384 * 2999 * ns_per_frame) <
        1000);
  CHECK(fit.frame_at(fit.time_of(frame + 12345)) == frame + 12345);
}

TEST_CASE(
    "with few pairs of frame and time the nominal rate is used, and a restarted device starts a new fit",
    "[drive][clock]") {
  FrameClock clock(192000);
  CHECK(clock.fit().pairs == 0);
  clock.add(100, 1000);
  CHECK(clock.fit().ns_per_frame == Approx(1e9 / 192000));
  CHECK(clock.fit().time_of(100) == 1000);
  clock.add(50, 2000);
  CHECK(clock.fit().pairs == 1);
  CHECK(clock.fit().time_of(50) == 2000);
}
