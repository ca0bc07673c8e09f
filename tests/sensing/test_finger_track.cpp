#include "station/sensing/finger_track.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/sensing/finger.hpp"
#include "tests/sensing/studies.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Root mean square errors of position and speed within the strokes of a simulated finger, and its mean
/// speed.
struct Errors {
  double position_mm = 0, speed_mm_s = 0, mean_speed_mm_s = 0;
};
Errors errors(const Finger& finger, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto recording = finger.record(random);
  const auto track = finger_track(recording.forces);
  Errors sum;
  double count = 0;
  for (const auto& stroke : find_strokes(track))
    for (std::size_t i = stroke.first; i < stroke.end; ++i) {
      const auto truth = recording.smooth_truth(static_cast<std::size_t>(track[i].index));
      sum.position_mm += std::pow(track[i].position_mm - truth.position_mm, 2);
      sum.speed_mm_s += std::pow(track[i].speed_mm_s - truth.speed_mm_s, 2);
      sum.mean_speed_mm_s += std::abs(truth.speed_mm_s);
      ++count;
    }
  REQUIRE(count > 1000);
  return {std::sqrt(sum.position_mm / count), std::sqrt(sum.speed_mm_s / count), sum.mean_speed_mm_s / count};
}

/// A finger that rests at 50 mm; its normal force is given for each millisecond.
std::vector<ForcePoint> resting(const std::vector<double>& normal_N) {
  std::vector<ForcePoint> all;
  for (std::size_t i = 0; i < normal_N.size(); ++i)
    all.push_back({static_cast<std::int64_t>(i), {normal_N[i], 0, 50 * normal_N[i]}});
  return all;
}

}  // namespace

TEST_CASE("position and speed of a moving finger are right", "[sensing]") {
  Finger finger;
  finger.friction_noise = 0;
  finger.friction_above = finger.friction_below = 0.5;
  const auto half = errors(finger, 1);
  say("track at 0.5 N: x ", half.position_mm, " mm, v ", 100 * half.speed_mm_s / half.mean_speed_mm_s,
      " % rms");
  CHECK(half.position_mm < 0.2);
  CHECK(half.speed_mm_s < 0.03 * half.mean_speed_mm_s);
  finger.friction_noise = 0.08;
  const auto rough = errors(finger, 2);
  say("with noise of friction: x ", rough.position_mm, " mm, v ",
      100 * rough.speed_mm_s / rough.mean_speed_mm_s, " %");
  CHECK(rough.position_mm < 0.2);
  finger.friction_noise = 0;
  finger.cell_noise_N = 1.5e-3;  // negative control: noisy cells must increase the error
  const auto noisy = errors(finger, 3);
  CHECK(noisy.speed_mm_s > 0.03 * noisy.mean_speed_mm_s);
}

TEST_CASE("position and speed have no delay and no unit error", "[sensing]") {
  for (const Band band : {Band::force, Band::wide}) {
    const double rate = points_per_second(band);
    std::vector<ForcePoint> forces;
    for (int i = 0; i < 4 * 300; ++i) {
      const double normal = 0.5 + 0.2 * std::sin(i / 100.0), x = 20 + 75 * i / rate;
      forces.push_back({i, {normal, 0.1, normal * x}});
    }
    for (const auto& finger : finger_track(forces, band)) {
      CHECK(finger.position_mm == Approx(20 + 75 * static_cast<double>(finger.index) / rate).margin(0.05));
      CHECK(finger.speed_mm_s == Approx(75).margin(1));
      CHECK(finger.normal_N == forces[static_cast<std::size_t>(finger.index)].force.normal_N);
    }
  }
}

TEST_CASE("contact begins after 20 ms of force, and ends when the force is small", "[sensing]") {
  std::vector<double> normal(500, 0.0);
  for (std::size_t i = 100; i < 119; ++i) normal[i] = 0.2;  // 19 ms are too short for a contact
  for (std::size_t i = 200; i < 300; ++i) normal[i] = 0.2;
  for (std::size_t i = 300; i < 320; ++i) normal[i] = 0.04;  // below 0.05 N, above 0.03 N
  int contacts = 0;
  for (const auto& finger : finger_track(resting(normal))) {
    CHECK(finger.contact == (finger.index >= 200 && finger.index < 320));
    contacts += finger.contact ? 1 : 0;
    if (!finger.contact) CHECK(std::isnan(finger.position_mm));
    if (finger.index >= 240 && finger.index < 280) CHECK(finger.position_mm == Approx(50));
  }
  CHECK(contacts == 120);
}

TEST_CASE("there is no position if the force is small or points are missing", "[sensing]") {
  std::vector<double> normal(1000, 0.5);
  for (std::size_t i = 300; i < 500; ++i) normal[i] = 0.08;
  auto forces = resting(normal);
  forces[700].force = {nan_value, nan_value, nan_value};
  for (const auto& finger : finger_track(forces)) {
    const auto near = [&](int from, int to, int reach) {
      return finger.index >= from - reach && finger.index < to + reach;
    };
    if (near(300, 500, -40)) {
      CHECK(finger.contact);
      CHECK(std::isnan(finger.position_mm));
      CHECK(std::isnan(finger.speed_mm_s));
    }
    if (finger.index == 700) CHECK(!finger.contact);
    if (near(700, 701, 35)) CHECK(std::isnan(finger.speed_mm_s));
    if (!near(300, 500, 40) && !near(700, 701, 40)) CHECK(finger.position_mm == Approx(50));
  }
  FingerTracker tracker;
  tracker.push(forces[0]);
  CHECK_THROWS_AS(tracker.push(forces[2]), std::logic_error);
}

TEST_CASE("strokes are long, fast and in one direction", "[sensing]") {
  // The finger moves 60 mm up, rests, moves 60 mm down with a slow moment after 40 mm, 25 mm up, and 40 mm up
  // too slowly.
  std::vector<FingerPoint> track;
  double x = 20;
  const auto move = [&](double speed_mm_s, int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      x += speed_mm_s / 1000;
      track.push_back({static_cast<std::int64_t>(track.size()), 0.5, 0.2, x, speed_mm_s, true});
    }
  };
  move(60, 1000), move(0, 100), move(-80, 500), move(-5, 50), move(-80, 250), move(50, 500), move(9.9, 4000);
  const auto strokes = find_strokes(track);
  REQUIRE(strokes.size() == 2);
  CHECK(strokes[0].direction == 1);
  CHECK(strokes[1].direction == -1);
  CHECK(track[strokes[0].first].position_mm == Approx(25).margin(0.2));
  CHECK(track[strokes[0].end - 1].position_mm == Approx(75).margin(0.2));
  CHECK(track[strokes[1].first].position_mm == Approx(75).margin(0.2));
  CHECK(track[strokes[1].end - 1].position_mm == Approx(45).margin(0.2));

  // Remove one point in the middle of a stroke, so that 30 mm of the stroke are left on either side. No
  // stroke may span the gap.
  track[500].speed_mm_s = track[500].position_mm = nan_value;
  CHECK(find_strokes(track).size() <= 3);
  for (const auto& stroke : find_strokes(track)) CHECK((stroke.end <= 500 || stroke.first > 500));
  CHECK(find_strokes({}).empty());
}
