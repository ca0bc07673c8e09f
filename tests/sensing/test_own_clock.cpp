#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "station/sensing/own_clock.hpp"
#include "station/sensing/trial_finger.hpp"
#include "tests/support/catch.hpp"

// Samples of force cells whose converter has a clock of its own, on the grid of playback frames. The
// references are the functions of time from which the samples are made.

using namespace turnpoint;
using sensing::BridgePoint;
using sensing::OwnClock;

namespace {

constexpr std::int64_t start_ns = 5'000'000'000'000;

/// Playback at 192 kHz, 0.3 promille too fast, whose frame 0 leaves the converter 2 s before the first
/// sample.
audio::ClockFit playback() {
  audio::ClockFit fit;
  fit.time_ns = start_ns - 2'000'000'000;
  fit.ns_per_frame = 1e9 / 192'000 / 1.0003;
  fit.pairs = 1024;
  return fit;
}

double seconds_at(const BridgePoint& point) {
  return 1e-9 * static_cast<double>(playback().time_of(point.index * 192) - start_ns);
}

/// The readings at a time: a ramp, a cubic, a constant.
sensing::Readings at(double s) { return {0.2 * s - 0.1, std::pow(0.3 * s - 0.5, 3), 0.25}; }

/// The last digits of a reading, which change from sample to sample.
double noise(std::int64_t n) { return 1e-8 * static_cast<double>(n * 7919 % 13); }

/// -0.1 to 0.1 ms, different for each sample.
std::int64_t jitter_ns(std::int64_t n) { return (n * 7919 % 201 - 100) * 1000; }

struct Recorder {
  OwnClock clock;
  double rate_Hz;
  std::vector<BridgePoint> points = {};

  void send(std::int64_t n, std::int64_t late_ns = 0) {
    const double s = static_cast<double>(n) / rate_Hz;
    clock.push({start_ns + std::llround(1e9 * s) + late_ns, at(s)}, playback(),
               [this](const BridgePoint& point) { points.push_back(point); });
  }
};

double largest_error(const std::vector<BridgePoint>& points, std::size_t cell, double from_s = 0) {
  double largest = 0;
  for (const auto& point : points)
    if (seconds_at(point) >= from_s)
      largest = std::max(largest, std::abs(point.ratio[cell] - at(seconds_at(point))[cell]));
  return largest;
}

bool in_a_row(const std::vector<BridgePoint>& points) {
  for (std::size_t k = 1; k < points.size(); ++k)
    if (points[k].index != points[k - 1].index + 1) return false;
  return true;
}

}  // namespace

TEST_CASE("samples with exact stamps give the exact readings at the frames of the grid, whatever their rate",
          "[sensing][own_clock]") {
  const double rate_Hz = GENERATE(80.0, 480.0, 997.0, 1000.0);
  Recorder recorder{OwnClock({.rate_Hz = rate_Hz}), rate_Hz};
  const auto count = static_cast<std::int64_t>(3 * rate_Hz);
  for (std::int64_t n = 0; n < count; ++n) recorder.send(n);
  // From the first sample to the last but one; the stamps are whole nanoseconds.
  CHECK(static_cast<double>(recorder.points.size()) == Approx(3000 - 2000 / rate_Hz).margin(3));
  CHECK(in_a_row(recorder.points));
  for (std::size_t cell = 0; cell < 3; ++cell) CHECK(largest_error(recorder.points, cell) < 1e-7);
  CHECK(recorder.clock.rate_Hz().has_value() == (count >= 256));
  if (recorder.clock.rate_Hz()) CHECK(*recorder.clock.rate_Hz() == Approx(rate_Hz).epsilon(1e-7));
  CHECK(recorder.clock.counters().lost == 0);
}

TEST_CASE("five samples that are left out are counted exactly, and the points around them are missing",
          "[sensing][own_clock]") {
  Recorder recorder{OwnClock({}), 1000};
  for (std::int64_t n = 0; n < 4000; ++n)
    if (n < 2000 || n >= 2005) recorder.send(n, jitter_ns(n));
  const auto& counters = recorder.clock.counters();
  CHECK(counters.samples == 3995);
  CHECK(counters.lost == 5);
  CHECK(counters.gaps == 1);
  CHECK(counters.disorder == 0);
  std::vector<BridgePoint> before, after;
  for (const auto& point : recorder.points) (seconds_at(point) < 2.002 ? before : after).push_back(point);
  CHECK(in_a_row(before));
  CHECK(in_a_row(after));
  CHECK(after.front().index - before.back().index - 1 == 7);
  CHECK(seconds_at(before.back()) < 1.999);
  CHECK(seconds_at(after.front()) > 2.005 - 1e-4);
}

TEST_CASE("a jitter of a tenth of a millisecond is averaged out", "[sensing][own_clock]") {
  Recorder recorder{OwnClock({}), 1000};
  for (std::int64_t n = 0; n < 4000; ++n) recorder.send(n, jitter_ns(n));
  CHECK(recorder.clock.counters().lost + recorder.clock.counters().disorder == 0);
  CHECK(in_a_row(recorder.points));
  // A stamp that is off by 0.1 ms alone would shift the ramp of 0.2/s by 2e-5. The standard error of the end
  // of a line through 256 stamps is 2 / sqrt(256) of their deviation of 0.058 ms: 7.3 us, or 1.5e-6.
  CHECK(largest_error(recorder.points, 0, 0.3) < 4 * 1.5e-6);
  CHECK(largest_error(recorder.points, 0, 0.3) > 0);
}

TEST_CASE("the delay of the converter's filter is subtracted", "[sensing][own_clock]") {
  Recorder recorder{OwnClock({.delay_ns = 2'500'000}), 1000};
  for (std::int64_t n = 0; n < 1000; ++n) recorder.send(n, 2'500'000);
  CHECK(largest_error(recorder.points, 0) < 1e-7);
}

TEST_CASE("a stamp that is late by more than half a sample counts as a gap, and what follows as disorder",
          "[sensing][own_clock]") {
  Recorder recorder{OwnClock({}), 1000};
  for (std::int64_t n = 0; n < 2000; ++n) recorder.send(n, n == 1000 ? 700'000 : 0);
  CHECK(recorder.clock.counters().lost == 1);
  CHECK(recorder.clock.counters().disorder == 1);
  CHECK_FALSE(in_a_row(recorder.points));
  CHECK(largest_error(recorder.points, 1) < 1e-7);
  CHECK(seconds_at(recorder.points.back()) > 1.99);
}

TEST_CASE("a cell whose samples stop to change is a fault, and one whose last digit flickers is none",
          "[sensing][own_clock]") {
  const bool flickers = GENERATE(true, false);
  OwnClock clock({});
  std::vector<BridgePoint> points;
  for (std::int64_t n = 0; n < 400; ++n) {
    const double b = n < 200 ? noise(n) : flickers && n % 50 == 0 ? 1e-8 : 0.0;
    clock.push({start_ns + n * 1'000'000, {noise(n), b, 0.1 + noise(n)}}, playback(), [&](const BridgePoint& point) { points.push_back(point); });
  }
  for (const auto& point : points) {
    // The decision needs 0.1 s.
    const bool dead = !flickers && seconds_at(point) > 0.3;
    if (dead || flickers || seconds_at(point) < 0.29)
      CHECK(point.fault == (dead ? sensing::WireFault::silent : sensing::WireFault::none));
    if (dead) CHECK(point.bridge == 1);
  }
}

TEST_CASE("a reading at the limit of the converter, or far beyond the rated load, is a fault of its cell",
          "[sensing][own_clock]") {
  const bool at_limit = GENERATE(true, false);
  OwnClock clock({.full_scale = {1, 0.5, 1}});
  std::vector<BridgePoint> points;
  for (std::int64_t n = 0; n < 200; ++n) {
    const bool off = n >= 100;
    clock.push({start_ns + n * 1'000'000,
                {0.1 + noise(n), (off && !at_limit ? 0.76 : 0.1) + noise(n), 0.1 + noise(n)},
                {false, off && at_limit, false}},
               playback(), [&](const BridgePoint& point) { points.push_back(point); });
  }
  CHECK(points.front().fault == sensing::WireFault::none);
  CHECK(points.back().fault == sensing::WireFault::overload);
  CHECK(points.back().bridge == 1);
}

TEST_CASE("a gap of the converter makes the forces of its trial unknown, and only of this trial",
          "[sensing][own_clock][finger]") {
  sensing::FingerSetup setup;
  setup.own_clock = true;
  setup.calibration = sensing::ForceCalibration({{{1, 0, 0}, {1, 0, 300}, {0, 1, 0}}}, {});
  setup.bridges.full_scale = {10, 10, 10};
  setup.length_mm = 300;
  sensing::TrialFinger finger(setup);
  OwnClock clock({.full_scale = {10, 10, 10}});
  std::int64_t n = 0;
  // Nobody touches until the trial; then 0.3 N rest at 100 mm, on both cells.
  const auto pass = [&](double seconds, double normal_N, std::int64_t leave_out = 0) {
    for (const auto end = n + static_cast<std::int64_t>(1000 * seconds); n < end; ++n) {
      if (leave_out-- > 0) continue;
      clock.push({start_ns + n * 1'000'000, {0.01 + normal_N * 2 / 3 + noise(n), 0.02 + normal_N / 3 + noise(n),
                                                    0.03 + noise(n)}},
                 playback(), [&](const BridgePoint& point) { finger.push(point); });
    }
  };
  const auto trial = [&](std::int64_t leave_out) {
    pass(1, 0);
    const auto begin = playback().frame_at(start_ns + n * 1'000'000);
    finger.expect(begin, {{begin + 96'000, begin + 192'000}});
    pass(0.75, 0.3);
    pass(0.5, 0.3, leave_out);
    return finger.result();
  };
  const auto first = trial(0);
  CHECK(first.state == sensing::ForcesState::ok);
  CHECK(first.track.back().normal_N == Approx(0.3));
  CHECK(first.track.back().position_mm == Approx(100).margin(1e-4));
  pass(0.2, 0);
  CHECK(trial(5).state == sensing::ForcesState::lost);
  pass(0.2, 0);
  CHECK(trial(0).state == sensing::ForcesState::ok);
}
