#include "station/sensing/felt_step.hpp"

#include <cmath>
#include <limits>

#include "physics/field.hpp"
#include "physics/friction.hpp"
#include "station/analysis/quantile.hpp"
#include "station/sensing/trial_finger.hpp"
#include "tests/sensing/finger.hpp"
#include "tests/sensing/studies.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

namespace {

const Bins bins{44, 2, 36};

struct Trial {
  std::vector<FingerPoint> track;
  std::vector<Stroke> strokes;
  FrictionProfile profile;
};
Trial trial(const Finger& finger, std::mt19937_64& random) {
  Trial result{finger_track(finger.record(random).forces), {}, {}};
  result.strokes = find_strokes(result.track);
  result.profile = friction_profile(result.track, result.strokes, bins);
  return result;
}

struct Study {
  double bias_mm = 0, sd_mm = 0, mean_se_mm = 0, covered = 0, covered_by_1_96 = 0, covered_by_half = 0,
         missing = 0;
};
Study study(const Finger& finger, int trials, unsigned seed) {
  std::mt19937_64 random(seed);
  Study result;
  double sum = 0, square = 0, count = 0;
  for (int i = 0; i < trials; ++i) {
    Finger moved = finger;
    // The step of friction may lie anywhere within a bin of the measured profile.
    moved.edge_mm += std::uniform_real_distribution(-1.0, 1.0)(random);
    const auto step = felt_step(trial(moved, random).profile);
    if (!step) {
      result.missing += 1.0 / trials;
      continue;
    }
    const double error = step->boundary_mm - moved.edge_mm;
    sum += error, square += error * error, ++count;
    result.mean_se_mm += step->se_mm;
    result.covered += std::abs(error) < step->half_interval_mm ? 1 : 0;
    result.covered_by_half += std::abs(error) < 0.5 * step->half_interval_mm ? 1 : 0;
    result.covered_by_1_96 += std::abs(error) < 1.96 * step->se_mm ? 1 : 0;
  }
  result.bias_mm = sum / count;
  result.sd_mm = std::sqrt((square - sum * sum / count) / (count - 1));
  result.mean_se_mm /= count;
  result.covered /= count;
  result.covered_by_1_96 /= count;
  result.covered_by_half /= count;
  return result;
}

void print(const char* what, const Study& s) {
  say(what, ": bias ", s.bias_mm, " mm, sd ", s.sd_mm, " mm, mean se ", s.mean_se_mm, " mm, covered ",
      100 * s.covered, " % (by 1.96 se ", 100 * s.covered_by_1_96, " %), none ", 100 * s.missing, " %");
}

}  // namespace

TEST_CASE("friction is the quotient of sums, per stroke and bin", "[sensing]") {
  std::vector<FingerPoint> track;
  const auto add = [&](double normal, double lateral, double position, bool contact = true) {
    track.push_back({static_cast<std::int64_t>(track.size()), normal, lateral, position, 50, contact});
  };
  // bin 0: the friction is the quotient of the sums, 0.7 / 1.2, and not the mean of the quotients
  add(1, -0.5, 10.5), add(0.2, -0.2, 11.5);
  // bin 1 stays empty: one point has too little force, the other no contact
  add(0.09, -0.09, 12.5), add(0.5, 0.1, 13, false);
  add(0.5, 0.1, 14.2), add(0.5, 0.15, 15.9);  // both points are in bin 2
  const std::vector<Stroke> strokes{{0, 6, 1}, {4, 6, 1}, {4, 5, -1}};
  const auto profile = friction_profile(track, strokes, {10, 2, 4});
  REQUIRE(profile.strokes.size() == 3);
  CHECK(profile.strokes[0].friction[0] == Approx(0.7 / 1.2));
  CHECK(std::isnan(profile.strokes[0].friction[1]));
  CHECK(profile.strokes[0].friction[2] == Approx(0.25));
  CHECK(std::isnan(profile.strokes[0].friction[3]));
  CHECK(profile.strokes[2].friction[2] == Approx(0.2));
  const auto mean = profile.mean(1);
  CHECK(mean.friction[2] == Approx(0.25));
  CHECK(mean.se[2] == Approx(0).margin(1e-12));
  CHECK(std::isnan(mean.se[0]));
  CHECK(mean.friction[0] == Approx(0.7 / 1.2));
  CHECK(mean_friction(track, std::span(strokes).first(1)) == Approx(0.95 / 2.2));
}

TEST_CASE("standard errors of a profile are those of its strokes", "[sensing]") {
  FrictionProfile profile{{0, 2, 1}, {}};
  for (const double mu : {0.4, 0.5, 0.6, 0.5}) profile.strokes.push_back({1, {mu}});
  const auto mean = profile.mean(1);
  CHECK(mean.friction[0] == Approx(0.5));
  CHECK(mean.se[0] == Approx(std::sqrt(0.02 / 3 / 4)));
  CHECK(std::isnan(profile.mean(-1).friction[0]));
}

TEST_CASE("a felt step is where friction changes, and its standard error is right", "[sensing]") {
  const int trials = repetitions(40);
  const bool many = trials >= 400;
  const Study six = study({}, trials, 1);
  print("contrast 0.5, 6 pairs", six);
  CHECK(six.missing == 0);
  CHECK(std::abs(six.bias_mm) < 0.2);
  CHECK(six.sd_mm < 0.5);
  CHECK(six.covered > (many ? 0.90 : 0.85));
  if (many) CHECK(six.covered < 0.98);
  CHECK(six.covered_by_half < 0.85);
  // negative control: a calibration that is 2 % off in position must be detected
  std::mt19937_64 random(4);
  auto recording = Finger().record(random);
  for (auto& point : recording.forces) point.force.moment_Nmm *= 1.02;
  const auto track = finger_track(recording.forces);
  const auto wrong = felt_step(friction_profile(track, find_strokes(track), bins));
  REQUIRE(wrong);
  CHECK(std::abs(wrong->boundary_mm - 80) > 1);

  // Without noise of friction all strokes agree, and what is left is the error of the fit's shape, which the
  // interval must hold as well. It is then too wide, but not by much.
  for (const double width_mm : {4.0, 10.0, 16.0})
    for (const double noise : {0.0, 0.02}) {
      Finger quiet;
      quiet.strokes = 6, quiet.friction_noise = noise, quiet.width_mm = width_mm;
      const Study exact = study(quiet, many ? trials : 12, 5);
      print(("friction noise " + std::to_string(noise) + ", width " + std::to_string(width_mm)).c_str(),
            exact);
      CHECK(exact.missing == 0);
      CHECK(exact.covered > (many ? 0.9 : 0.8));
      CHECK(exact.mean_se_mm < (noise > 0 ? 3 * exact.sd_mm : 0.2));
      // negative control: the scatter of strokes that agree says nothing, so this error is that of the shape
      if (noise == 0) CHECK(exact.mean_se_mm > exact.sd_mm);
    }

  if (wanted_studies == nullptr) return;
  Finger finger;
  for (const double above : {0.4, 0.64, 0.8})
    for (const int pairs : {2, 3, 6, 12}) {
      finger.friction_above = above;
      finger.strokes = 2 * pairs;
      const auto what = "contrast " + std::to_string(1 - above / 0.8) + ", pairs: " + std::to_string(pairs);
      print(what.c_str(), study(finger, trials, 2));
    }
}

TEST_CASE("a boundary at a level of friction is where a plate's friction crosses it", "[sensing]") {
  namespace physics = turnpoint::physics;
  const auto surface = physics::aluminium_plate();
  const physics::FrictionMap map;
  std::vector<double> x_m;
  for (int i = 0; i <= 3000; ++i) x_m.push_back(1e-4 * i);
  for (const double frequency_Hz : {26e3, 29e3, 33e3}) {
    const physics::Tone tone{frequency_Hz, 1, 0};
    const auto field =
        physics::evaluate_tones(surface, {&tone, 1}, x_m, physics::Model::mode, physics::Normalise::peak);
    std::vector<double> local;
    for (const auto& v : field[0].v) local.push_back(map.relative_friction(3e-6 * std::abs(v)));
    const auto friction = physics::fingertip_average(x_m, local, 0.01);
    const Bins whole{70, 2, 80};
    StrokeFriction stroke{1, {}};
    for (std::size_t bin = 0; bin < whole.count; ++bin) {
      double sum = 0;
      for (std::size_t i = 0; i < 20; ++i) sum += friction[700 + 20 * bin + i] / 20;
      stroke.friction.push_back(0.8 * sum);
    }
    auto back = stroke;
    back.direction = -1;
    const FrictionProfile profile{whole, {stroke, back, stroke, back}};
    for (const double level : {0.3, 0.4, 0.55, 0.65, 0.8}) {
      std::size_t i = friction.size() - 1;
      while (friction[i] > level) --i;
      const double crossing_mm =
          0.1 * (static_cast<double>(i) + (level - friction[i]) / (friction[i + 1] - friction[i]));
      CAPTURE(frequency_Hz, level);
      const auto felt = felt_step(profile, level);
      REQUIRE(felt);
      CHECK(felt->boundary_mm == Approx(crossing_mm).margin(level < 0.7 ? 0.15 : 0.3));
      // these strokes agree exactly, so the whole error is that of the shape
      CHECK(std::abs(felt->boundary_mm - crossing_mm) < felt->half_interval_mm);
      CHECK(felt->half_interval_mm < 3);
      CHECK(felt->se_mm > 0.01);
      // negative control: the boundary half-way up the step is at a different place
      if (level == 0.8) CHECK(std::abs(felt_step(profile)->boundary_mm - crossing_mm) > 2);
    }
    CHECK_FALSE(felt_step(profile, 0.05));  // friction never falls so low
  }
}

TEST_CASE("the skin's lag shows as half the difference of the directions", "[sensing]") {
  std::mt19937_64 random(7);
  Finger finger;
  finger.friction_noise = 0.02;
  const auto none = felt_step(trial(finger, random).profile);
  finger.lag_mm = 2;
  const auto lag = felt_step(trial(finger, random).profile);
  REQUIRE((none && lag));
  CHECK(std::abs(none->lag_mm) < 0.3);
  CHECK(lag->lag_mm == Approx(2).margin(0.4));
  CHECK(lag->boundary_mm == Approx(80).margin(0.4));
  CHECK(lag->friction_below == Approx(0.8).margin(0.05));
  CHECK(lag->friction_above == Approx(0.4).margin(0.05));
}

TEST_CASE("one outlying bin does not move the felt step", "[sensing]") {
  FrictionProfile profile{{0, 2, 30}, {}};
  const auto fill = [&](double outlier) {
    profile.strokes.clear();
    for (int stroke = 0; stroke < 6; ++stroke) {
      StrokeFriction one{stroke % 2 == 0 ? 1 : -1, {}};
      for (std::size_t i = 0; i < 30; ++i)
        one.friction.push_back(0.3 + 0.2 / (1 + std::exp(-(profile.bins.centre_mm(i) - 31) / 2)) +
                               0.004 * std::sin(7.0 * static_cast<double>(i) + stroke));
      one.friction[18] += outlier;
      profile.strokes.push_back(one);
    }
    return felt_step(profile);
  };
  REQUIRE(fill(0));
  CHECK(fill(0)->boundary_mm == Approx(31).margin(0.1));
  REQUIRE(fill(-0.15));
  CHECK(fill(-0.15)->boundary_mm == Approx(31).margin(0.2));
}

TEST_CASE("too few strokes, one direction or no step give no boundary", "[sensing]") {
  std::mt19937_64 random(9);
  auto profile = trial({}, random).profile;
  CHECK(felt_step(profile));
  auto few = profile;
  few.strokes.resize(3);
  CHECK(felt_step(few));
  few.strokes.resize(2);
  CHECK(!felt_step(few));
  auto one_way = profile;
  std::erase_if(one_way.strokes, [](const StrokeFriction& stroke) { return stroke.direction < 0; });
  REQUIRE(one_way.strokes.size() == 6);
  CHECK(!felt_step(one_way));
  CHECK(!felt_step({}));
  Finger even;
  even.friction_above = even.friction_below;
  int found = 0;
  for (int i = 0; i < 20; ++i) found += felt_step(trial(even, random).profile) ? 1 : 0;
  CHECK(found <= 1);
}

TEST_CASE("the summary of a trial says what the finger did", "[sensing]") {
  std::mt19937_64 random(12);
  Finger finger;
  finger.normal_noise = 0.05;
  const auto one = trial(finger, random);
  MovementWindow usual;
  usual.least_normal_N = 0.35, usual.most_normal_N = 0.65;
  usual.least_speed_mm_s = 40, usual.most_speed_mm_s = 120;
  const auto summary = summarise(one.track, Band::force, one.strokes, usual);
  CHECK(summary.contact_s == Approx(static_cast<double>(one.track.size()) / 1000));
  CHECK(summary.strokes == 12);
  CHECK(summary.normal_N == Approx(0.5).epsilon(0.05));
  CHECK(summary.normal_sd_N == Approx(0.025).epsilon(0.2));
  CHECK(summary.normal_in_window == 1);
  CHECK(summary.speed_mm_s > 80);
  CHECK(summary.speed_in_window > 0.3);
  CHECK(summary.speed_in_window < 0.9);
  MovementWindow heavy;
  heavy.least_normal_N = 0.6, heavy.most_normal_N = 1;
  CHECK(summarise(one.track, Band::force, one.strokes, heavy).normal_in_window < 0.1);
  const auto any = summarise(one.track, Band::force, one.strokes, {});
  CHECK(std::isnan(any.normal_in_window));
  CHECK(std::isnan(any.speed_in_window));

  const auto nothing = summarise({}, Band::force, {}, {});
  CHECK(nothing.contact_s == 0);
  CHECK(nothing.strokes == 0);
  CHECK(std::isnan(nothing.normal_N));
}

TEST_CASE("a movement is judged by strokes, then force, then speed", "[sensing]") {
  TrialSummary summary;
  summary.strokes = 4;
  summary.normal_N = 0.5, summary.normal_in_window = 0.9;
  summary.speed_mm_s = 80, summary.speed_in_window = 0.9;
  MovementWindow window;
  window.least_normal_N = 0.35, window.most_normal_N = 0.65;
  window.least_speed_mm_s = 40, window.most_speed_mm_s = 120;
  window.strokes = 4;
  CHECK(judge(summary, window) == Movement::ok);
  summary.speed_in_window = 0.7, summary.speed_mm_s = 110;
  CHECK(judge(summary, window) == Movement::fast);
  summary.speed_mm_s = 50;
  CHECK(judge(summary, window) == Movement::slow);
  summary.normal_in_window = 0.7, summary.normal_N = 0.6;
  CHECK(judge(summary, window) == Movement::hard);
  summary.normal_N = 0.4;
  CHECK(judge(summary, window) == Movement::light);
  summary.strokes = 3;
  CHECK(judge(summary, window) == Movement::strokes);
  CHECK(judge(TrialSummary{}, MovementWindow{}) == Movement::ok);
}
