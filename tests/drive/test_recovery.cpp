#include <cerrno>
#include <cmath>

#include "station/drive/rate_check.hpp"
#include "station/drive/recovery.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::drive;
using Action = RecoveryAction;

TEST_CASE("an underrun restarts the device, an interruption does not", "[drive][recovery]") {
  Recovery recovery;
  CHECK(recovery.transferred({0}) == Action::go_on);
  CHECK(recovery.transferred({-EINTR}) == Action::go_on);
  CHECK(recovery.transferred({-EAGAIN}) == Action::go_on);
  CHECK(recovery.transferred({-EPIPE}) == Action::restart);
  CHECK(recovery.acted({0}) == Action::go_on);
  CHECK_FALSE(recovery.lost());
}

TEST_CASE("a suspended device is resumed, waited for, and restarted where it cannot resume",
          "[drive][recovery]") {
  Recovery recovery;
  CHECK(recovery.transferred({-ESTRPIPE}) == Action::resume);
  SECTION("it resumes after a while") {
    CHECK(recovery.acted({-EAGAIN}) == Action::wait);
    CHECK(recovery.acted({-EAGAIN}) == Action::wait);
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

TEST_CASE("an unplugged device is abandoned, tried four times a second, and comes back",
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
  CHECK_FALSE(limit.exceeded_by(61 * second));  // the first is more than a minute ago
  CHECK(limit.exceeded_by(62 * second));
}

TEST_CASE("a device that really runs at another rate is found out within seconds", "[drive][rate]") {
  const auto measured = [](double real_rate_Hz, double jitter_ns, double seconds) {
    RateCheck check(192000);
    for (double t = 0; t < seconds; t += 0.002)
      check.add(std::llround(t * real_rate_Hz),
                10'000'000'000 + std::llround(t * 1e9 + jitter_ns * std::sin(t * t * 1e5)));
    return check.result();
  };
  CHECK_FALSE(measured(192000, 1000, 1.9).has_value());
  CHECK(std::abs(measured(192000, 1000, 2.1)->deviation_ppm) < 10);
  CHECK(measured(192000 * (1 + 300e-6), 1000, 2.1)->deviation_ppm == Approx(300).margin(10));
  CHECK(measured(48000 * 4.001, 1000, 2.1)->deviation_ppm > RateCheck::tolerance_ppm);
  CHECK_FALSE(measured(192000, 4e6, 2.1).has_value());  // too coarse stamps to judge yet
  CHECK(std::abs(measured(192000, 4e6, 20.5)->deviation_ppm) < 100);
}
