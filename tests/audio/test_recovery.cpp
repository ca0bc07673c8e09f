#include <cerrno>
#include <cmath>

#include "station/audio/rate_check.hpp"
#include "station/audio/recovery.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;
using Action = RecoveryAction;

TEST_CASE("an underrun restarts the device, but an interrupted call does not", "[drive][recovery]") {
  Recovery recovery;
  CHECK(recovery.transferred({0}) == Action::go_on);
  CHECK(recovery.transferred({-EINTR}) == Action::go_on);
  CHECK(recovery.transferred({-EAGAIN}) == Action::go_on);
  CHECK(recovery.transferred({-EPIPE}) == Action::restart);
  CHECK(recovery.acted({0}) == Action::go_on);
  CHECK_FALSE(recovery.lost());
}

TEST_CASE("a suspended device is resumed and awaited, and restarted whether or not it could resume",
          "[drive][recovery]") {
  Recovery recovery;
  CHECK(recovery.transferred({-ESTRPIPE}) == Action::resume);
  SECTION("it resumes after a while") {
    CHECK(recovery.acted({-EAGAIN}) == Action::wait);
    CHECK(recovery.acted({-EAGAIN}) == Action::wait);
    CHECK(recovery.acted({0}) == Action::restart);
    CHECK(recovery.acted({0}) == Action::go_on);
  }
  SECTION("the driver cannot resume") {
    CHECK(recovery.acted({-ENOSYS}) == Action::restart);
    CHECK(recovery.acted({0}) == Action::go_on);
  }
  SECTION("it never comes back") {
    int waits = 0;
    while (recovery.acted({-EAGAIN}) == Action::wait && waits < 1000) ++waits;
    CHECK(waits < 100);
    CHECK(recovery.acted({-EIO}) == Action::abandon);
    CHECK(recovery.lost());
  }
}

TEST_CASE("an unplugged device is closed and tried again four times a second until it returns",
          "[drive][recovery]") {
  Recovery recovery;
  SECTION("the call says so") { CHECK(recovery.transferred({-ENODEV}) == Action::abandon); }
  SECTION("only the state says so") { CHECK(recovery.transferred({0, true}) == Action::abandon); }
  SECTION("in the middle of a restart") {
    CHECK(recovery.transferred({-EPIPE}) == Action::restart);
    CHECK(recovery.acted({-ENODEV}) == Action::abandon);
  }
  CHECK(recovery.lost());
  int tries = 0;
  for (std::int64_t ms = 2; ms <= 2000; ms += 2)
    if (recovery.absent(ms * 1'000'000) == Action::reopen) {
      ++tries;
      CHECK(recovery.reopened(-ENOENT) == Action::wait);
    }
  CHECK(tries == 8);
  REQUIRE(recovery.absent(3'000'000'000) == Action::reopen);
  CHECK(recovery.reopened(0) == Action::back);
  CHECK_FALSE(recovery.lost());
}

TEST_CASE("more than three underruns within a minute are too many", "[drive][recovery]") {
  UnderrunLimit limit;
  const auto second = std::int64_t{1'000'000'000};
  CHECK_FALSE(limit.exceeded_by(0));
  CHECK_FALSE(limit.exceeded_by(20 * second));
  CHECK_FALSE(limit.exceeded_by(40 * second));
  CHECK_FALSE(limit.exceeded_by(61 * second));  // the first underrun is more than a minute ago
  CHECK(limit.exceeded_by(62 * second));
}

TEST_CASE("a device whose real rate differs from the nominal rate is detected within seconds",
          "[drive][rate]") {
  // The device updates its position only every `tick_s` seconds, so a reported position can be that old.
  const auto measured = [](double real_rate_Hz, double tick_s, double seconds) {
    RateCheck check(192000);
    for (int i = 0; i < seconds / 0.002; ++i) {
      const double t = i * 0.002, told = tick_s > 0 ? std::floor(t / tick_s * (1 + 1e-5)) * tick_s : t;
      check.add(std::llround(told * real_rate_Hz), 10'000'000'000 + std::llround(t * 1e9));
    }
    return check.result();
  };
  CHECK_FALSE(measured(192000, 0, 1.9).has_value());
  CHECK(std::abs(measured(192000, 0, 2.1).value().deviation_ppm) < 10);
  CHECK(measured(192000 * (1 + 300e-6), 0, 2.1).value().deviation_ppm == Approx(300).margin(10));
  CHECK(measured(48000 * 4.001, 0, 2.1).value().deviation_ppm > RateCheck::tolerance_ppm);
  // with this coarse tick, 2 s are too short for a result
  CHECK_FALSE(measured(192000, 0.013, 2.1).has_value());
  CHECK(std::abs(measured(192000, 0.013, 20.5).value().deviation_ppm) < 100);
}
