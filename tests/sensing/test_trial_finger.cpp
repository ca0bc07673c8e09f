#include <cmath>

#include "station/sensing/trial_finger.hpp"
#include "tests/sensing/bridge_signal.hpp"
#include "tests/sensing/cells.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

namespace {

constexpr std::int64_t second = 192000;

/// A finger that lands and then rests at one place. Before it lands, something may already lie on the
/// surface.
struct Scene {
  double normal_N = 0.5, lateral_N = 0.2, place_mm = 90, lands_s = 1.0, lying_N = 0;
};

struct Bench {
  Bench() : random(5), cells(random) {
    std::vector<DeadWeight> weights;
    for (const double place : {20.0, 80.0, 140.0})
      for (const double pull : {-0.5, 0.0, 0.5})
        weights.push_back({1, pull, place, cells.readings(1, pull, place)});
    setup.calibration = fit_weights(weights).calibration;
    setup.bridges = bridge_options();
    setup.length_mm = 160;
  }
  std::vector<std::int32_t> samples(const Scene& scene, std::int64_t first, std::size_t frames) {
    BridgeSignal signal;
    signal.noise_V_rtHz = 4e-9;
    signal.forces_N = [this, scene](double t) {
      const bool on = t >= scene.lands_s;
      auto readings = cells.readings(on ? scene.normal_N : scene.lying_N, on ? scene.lateral_N : 0,
                                     on || scene.lying_N > 0 ? scene.place_mm : 0);
      for (auto& reading : readings) reading *= BridgeSignal::N_per_ratio;
      return readings;
    };
    return signal.frames(first, frames);
  }

  std::mt19937_64 random;
  Cells cells;
  FingerSetup setup;
};

/// Pushes samples that begin at frame 0. The trial is announced after the samples before frame `quiet_until`
/// have been pushed.
void trial(TrialFinger& finger, const std::vector<std::int32_t>& samples, std::int64_t quiet_until,
           const std::vector<TrialFinger::Range>& intervals) {
  const auto before = static_cast<std::size_t>(4 * quiet_until);
  finger.push({std::span(samples).first(before), 4, 0});
  finger.expect(quiet_until, intervals);
  finger.push({std::span(samples).subspan(before), 4, quiet_until});
}

}  // namespace

TEST_CASE("the forces of a trial are those on the cells, minus the tare before it", "[sensing]") {
  Bench bench;
  TrialFinger finger(bench.setup);
  const auto samples = bench.samples({}, 0, 3 * second);
  trial(finger, samples, second - 9600,
        {{second + 19200, 2 * second}, {2 * second + 9600, 2 * second + 96000}});
  CHECK(finger.contact(0) == true);
  const auto forces = finger.result();
  CHECK(std::string(name(forces.state)) == "ok");
  CHECK(forces.summary.contact_s == Approx(1.4).margin(0.01));
  CHECK(forces.summary.strokes == 0);
  std::size_t seen = 0;
  for (const auto& point : forces.track) {
    if (std::isnan(point.position_mm)) continue;
    ++seen;
    CHECK(point.normal_N == Approx(0.5).margin(0.005));
    CHECK(point.lateral_N == Approx(0.2).margin(0.005));
    CHECK(point.position_mm == Approx(90).margin(0.5));
  }
  CHECK(seen > 1300);
  // result() ends the trial, and no other trial has been announced, so there is nothing to return.
  CHECK(finger.result().track.empty());
}

TEST_CASE("missing frames, a wire fault and a load before the trial are told apart", "[sensing]") {
  Bench bench;
  TrialFinger finger(bench.setup);
  const auto good = bench.samples({}, 0, 2 * second);
  trial(finger, good, second - 9600, {{second + 9600, second + 96000}});
  REQUIRE(std::string(name(finger.result().state)) == "ok");

  // Each trial lasts two seconds, and the finger lands in the middle of these.
  const auto state = [&](const Scene& scene, std::int64_t lost) {
    const auto samples = bench.samples(scene, 0, 2 * second);
    const std::int64_t begin = 2 * second, gap = begin + second + 30000;
    const auto before = static_cast<std::size_t>(4 * (gap - begin));
    finger.push({std::span(samples).first(before), 4, begin});
    finger.expect(begin + second - 9600, {{begin + second + 9600, begin + second + 96000}});
    const auto after = before + static_cast<std::size_t>(4 * lost);
    finger.push({std::span(samples).subspan(after), 4, gap + lost});
    return std::string(name(finger.result().state));
  };
  SECTION("nothing is wrong") { CHECK(state({}, 0) == "ok"); }
  SECTION("one lost millisecond") { CHECK(state({}, 192) == "lost"); }
  SECTION("a load of 50 mN") {
    Scene loaded;
    loaded.lying_N = 0.05;
    CHECK(state(loaded, 0) == "tare");
  }
}

TEST_CASE("an interval that is stopped ends there, and one that has not begun is no longer expected",
          "[sensing]") {
  Bench bench;
  TrialFinger finger(bench.setup);
  const auto samples = bench.samples({}, 0, 2 * second);
  trial(finger, samples, second - 9600, {{second + 9600, 2 * second}, {3 * second, 4 * second}});
  finger.cut(second + 96000);
  CHECK(finger.known_at() == second + 96000 + static_cast<std::int64_t>(TrialFinger::tail_s * second));
  CHECK(finger.result().summary.contact_s == Approx(0.45).margin(0.01));
  finger.expect(second, {{second + 9600, 2 * second}});
  finger.cut(second);
  CHECK(std::string(name(finger.result().state)) == "lost");
}

TEST_CASE("without a tare at the first trial the forces are not known", "[sensing]") {
  Bench bench;
  TrialFinger finger(bench.setup);
  const auto samples = bench.samples({}, 0, 2 * second);
  // only 156 ms of silence before the trial are captured, which is too little to measure the tare (the
  // readings without a finger)
  trial(finger, samples, 30000, {{second + 9600, second + 96000}});
  const auto forces = finger.result();
  CHECK(std::string(name(forces.state)) == "tare");
  CHECK(forces.track.empty());
}
