#include <algorithm>
#include <complex>
#include <cstring>
#include <vector>

#include "station/audio/sine.hpp"
#include "station/sensing/lock_in.hpp"
#include "tests/sensing/room.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

namespace {

using Complex = std::complex<double>;

struct Point {
  double frame;
  std::vector<Complex> values;
};

FollowedTone followed(double frequency_Hz, double phase_rad, std::int64_t origin, int rate_Hz) {
  return {{audio::phase_of_angle(phase_rad), audio::phase_increment(frequency_Hz, rate_Hz), 0, 0, 0}, origin};
}

std::vector<Point> points_of(LockIn& lock_in, const Room& room, std::span<const std::int32_t> samples,
                             std::int64_t first, const std::vector<std::int64_t>& sizes) {
  std::vector<Point> points;
  in_blocks(room, samples, first, sizes, [&](const CaptureBlock& block) {
    lock_in.push(block, [&](double frame, std::span<const Complex> values) {
      points.push_back({frame, {values.begin(), values.end()}});
    });
  });
  return points;
}

audio::Burst two_tones() {
  audio::Burst burst;
  burst.start_frame = 1'000'000'007;
  burst.length_frames = 60000;
  burst.ramp.frames = 960;
  burst.tones.count = 2;
  burst.tones.tones[0] = {30000.25, 0.4, 0.3, 0};
  burst.tones.tones[1] = {34123.4, 0.2, -1.1, 0};
  return burst;
}

}  // namespace

TEST_CASE("a lock-in gives amplitude and phase of each tone, with the delay removed", "[sensing]") {
  Room room;
  room.noise = 0;
  const auto burst = two_tones();
  const std::int64_t first = burst.start_frame + 5000;
  const auto samples = captured(room, burst, first, 30000);
  std::vector<FollowedTone> tones;
  for (int i = 0; i < 2; ++i) {
    const auto& tone = burst.tones.tones[static_cast<std::size_t>(i)];
    tones.push_back(followed(tone.frequency_Hz, tone.phase_rad, burst.start_frame, room.rate_Hz));
  }
  LockIn lock_in(room.rate_Hz, room.channels, {4}, tones, room.delay_frames);
  const auto points = points_of(lock_in, room, samples, first, {384});
  REQUIRE(points.size() > 100);
  for (const Point& point : points) {
    const double t = (point.frame - static_cast<double>(burst.start_frame)) / room.rate_Hz;
    if (t < 0.012) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& tone = burst.tones.tones[i];
      const Complex expected = tone.amplitude * room.pick_ups[0].response(tone.frequency_Hz);
      CHECK(std::abs(point.values[i] / expected - 1.0) < 1e-4);
    }
  }
  SECTION("and a wrong delay is seen as a phase error: the negative control") {
    LockIn wrong(room.rate_Hz, room.channels, {4}, tones, room.delay_frames + 0.5);
    const auto shifted = points_of(wrong, room, samples, first, {384});
    const Complex expected = burst.tones.tones[0].amplitude * room.pick_ups[0].response(30000.25);
    CHECK(std::arg(shifted.back().values[0] / expected) ==
          Approx(2 * M_PI * 30000.25 * 0.5 / room.rate_Hz).margin(1e-3));
  }
}

TEST_CASE("a tone at a distance of 1.05 kHz leaks into a lock-in by less than 6e-4", "[sensing]") {
  Room room;
  room.noise = 0;
  auto burst = two_tones();
  burst.tones.count = 1;
  const std::int64_t first = burst.start_frame + 10000;
  const auto samples = captured(room, burst, first, 40000);
  const auto leak = [&](double distance_Hz) {
    LockIn lock_in(room.rate_Hz, room.channels, {4},
                   {followed(30000.25 + distance_Hz, 0, burst.start_frame, room.rate_Hz)}, 0);
    double largest = 0;
    for (const Point& point : points_of(lock_in, room, samples, first, {384}))
      largest = std::max(largest, std::abs(point.values[0]) / 0.2);
    return largest;
  };
  CHECK(leak(1050) < 6e-4);
  CHECK(leak(-1050) < 6e-4);
  CHECK(leak(100) > 0.3);  // negative control: 100 Hz is within the window's bandwidth
  // near multiples of 1 kHz, sums over 1 ms alone would let aliases through
  double largest = 0;
  for (const double distance : {2050.0, 3050.0, 4050.0, 8050.0, 16050.0})
    largest = std::max(largest, leak(distance));
  CHECK(largest < 1e-4);
}

TEST_CASE("the points of a lock-in do not depend on the sizes of the blocks", "[sensing]") {
  Room room;
  const auto burst = two_tones();
  const std::int64_t first = burst.start_frame + 4321;
  const auto samples = captured(room, burst, first, 20000);
  const auto run = [&](const std::vector<std::int64_t>& sizes) {
    LockIn lock_in(room.rate_Hz, room.channels, {4, 0},
                   {followed(30000.25, 0.3, burst.start_frame, room.rate_Hz)}, room.delay_frames);
    return points_of(lock_in, room, samples, first, sizes);
  };
  const auto expected = run({20000});
  for (const auto& sizes : std::vector<std::vector<std::int64_t>>{{1}, {384}, {7, 500, 1, 96}, {95, 97}}) {
    const auto points = run(sizes);
    REQUIRE(points.size() == expected.size());
    bool same = true;
    for (std::size_t k = 0; k < points.size(); ++k)
      same = same && points[k].frame == expected[k].frame &&
             std::memcmp(points[k].values.data(), expected[k].values.data(), 2 * sizeof(Complex)) == 0;
    CHECK(same);
  }
}

TEST_CASE("lost frames make the points around them invalid and no others", "[sensing]") {
  Room room;
  room.noise = 0;
  const auto burst = two_tones();
  const std::int64_t first = (burst.start_frame + 8000) / 192 * 192;  // first frame of a block
  const auto samples = captured(room, burst, first, 40000);
  const std::int64_t lost_at = 20000, lost = 300;
  const auto frames_between = [&](std::int64_t from, std::int64_t to) {
    return CaptureBlock{std::span(samples).subspan(static_cast<std::size_t>(from * room.channels),
                                                   static_cast<std::size_t>((to - from) * room.channels)),
                        room.channels, first + from, room.rate_Hz};
  };
  {
    LockIn lock_in(room.rate_Hz, room.channels, {4},
                   {followed(30000.25, 0.3, burst.start_frame, room.rate_Hz)}, room.delay_frames);
    int good = 0, bad = 0;
    double worst = 0;
    const auto sink = [&](double frame, std::span<const Complex> values) {
      const double from_gap =
          std::fabs(frame + room.delay_frames - static_cast<double>(first + lost_at + 150));
      if (std::isnan(values[0].real())) {
        ++bad;
        CHECK(from_gap < 150 + 960 + 192);
      } else {
        ++good;
        CHECK(from_gap > 150 + 960 - 192);
        worst = std::max(worst, std::fabs(std::abs(values[0]) - 0.2));
      }
    };
    lock_in.push(frames_between(0, lost_at), sink);
    lock_in.push(frames_between(lost_at + lost, 40000), sink);
    CHECK(bad >= 10);
    CHECK(good > 150);
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("a lock-in follows a tone that glides", "[sensing]") {
  // The tone glides from 30 to 32 kHz in 0.2 s; its phase is 2 pi (f t + slope t^2 / 2).
  constexpr int rate = 192000;
  constexpr std::int64_t frames = 38400, origin = 5'000'000'000;
  const std::uint64_t from = audio::phase_increment(30000, rate), to = audio::phase_increment(32000, rate);
  const std::uint64_t curvature = (to - from) / frames;
  std::vector<std::int32_t> samples(frames);
  for (std::int64_t n = 0; n < frames; ++n) {
    const long double m = static_cast<long double>(n);
    const long double cycles = 30000.0L / rate * m + 2000.0L / rate / frames * m * (m - 1) / 2;
    samples[static_cast<std::size_t>(n)] =
        converted(static_cast<double>(0.3L * std::sin(2 * 3.14159265358979323846L * cycles + 0.5L)));
  }
  LockIn lock_in(rate, 1, {0}, {{{0, from, curvature, 0, 0}, origin}}, 1234);
  int good = 0;
  lock_in.push({samples, 1, origin + 1234, rate}, [&](double, std::span<const Complex> values) {
    if (std::isnan(values[0].real())) return;
    CHECK(std::abs(values[0] - std::polar(0.3, 0.5)) < 1e-4);
    ++good;
  });
  CHECK(good > 180);
  LockIn steady(rate, 1, {0}, {{{0, from, 0, 0, 0}, origin}}, 1234);
  double smallest = 1;
  steady.push({samples, 1, origin + 1234, rate}, [&](double, std::span<const Complex> values) {
    if (!std::isnan(values[0].real())) smallest = std::min(smallest, std::abs(values[0]));
  });
  CHECK(smallest < 0.01);  // negative control: without curvature the lock-in loses the tone
}
