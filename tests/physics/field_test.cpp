#include "physics/field.hpp"

#include <cmath>
#include <limits>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

bool finite(const Field& field) {
  for (const ToneField& tone : field.tones) {
    for (const auto& v : tone.v) {
      if (!std::isfinite(v.real()) || !std::isfinite(v.imag())) return false;
    }
    for (const double ln : tone.ln_amplitude) {
      if (!std::isfinite(ln)) return false;
    }
  }
  for (const double a : field.amplitude) {
    if (!std::isfinite(a)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("normalising sets the drive edge or the last maximum to one, or leaves metres", "[physics]") {
  Surface s = seed_brass();
  s.quality_factor = 60;
  const Tone tone{19600, 2e-6, 0};
  const auto x = linspace_points(s, 2001);
  const Field drive = evaluate(s, {&tone, 1}, x, Model::mode, Normalise::drive);
  CHECK(std::abs(drive.tones[0].v[0] - 1.0) < 1e-13);
  const Field metres = evaluate(s, {&tone, 1}, x, Model::mode, Normalise::none);
  CHECK(std::abs(metres.tones[0].v[0] - 2e-6) < 1e-18);
  const Field peak = evaluate(s, {&tone, 1}, x, Model::mode, Normalise::peak);
  double most = 0;
  for (std::size_t i = 1000; i < x.size(); ++i) most = std::max(most, peak.amplitude[i]);
  CHECK(most == Approx(1).margin(1e-5));
  CHECK(drive.tones[0].info.gain == Approx(drive.amplitude[500] / peak.amplitude[500]).epsilon(1e-10));
  CHECK(drive_amplitude_m(s, 19600, 1e-6) == Approx(1e-6 / drive.tones[0].info.gain).epsilon(1e-12));
}

TEST_CASE("a tone's phase rotates its complex displacement, and the powers of several tones add",
          "[physics]") {
  Surface s = seed_brass();
  s.quality_factor = 60;
  const Tone tones[] = {{20000, 1e-6, 0}, {21500, 0.5e-6, 1.0}};
  const auto x = linspace_points(s, 101);
  const Field field = evaluate(s, tones, x, Model::mode, Normalise::none);
  CHECK(std::arg(field.tones[1].v[0]) == Approx(1.0));
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double sum = std::norm(field.tones[0].v[i]) + std::norm(field.tones[1].v[i]);
    CHECK(field.amplitude[i] == Approx(std::sqrt(sum)).epsilon(1e-12));
  }
}

TEST_CASE("points in any order give the same values as ascending points", "[physics]") {
  const Surface s = seed_brass();
  const Tone tone{30000, 1, 0};
  const std::vector<double> up{0, 0.01, 0.1, 0.2, 0.25, 0.29, 0.3}, down(up.rbegin(), up.rend());
  const Field a = evaluate(s, {&tone, 1}, up, Model::mode, Normalise::peak);
  const Field b = evaluate(s, {&tone, 1}, down, Model::mode, Normalise::peak);
  for (std::size_t i = 0; i < up.size(); ++i) CHECK(a.amplitude[i] == b.amplitude[up.size() - 1 - i]);
}

TEST_CASE("no value is infinite or undefined, from a strip to a steep wedge and from Q = 1 to no loss",
          "[physics]") {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double d : {0.0, 1e-6, 0.001, 0.03, 0.5, 1.0}) {
    for (const double f : {4.9e3, 19.6e3, 90e3}) {
      for (const double q : {1.0, 5.0, 60.0, 1e6, infinite}) {
        Surface s = seed_brass();
        s.quality_factor = q;
        s.taper = LinearTaper{0.03, d};
        s.length_m = d > 0 ? std::min(3.0, 0.03 / d) : 3.0;
        CAPTURE(d, f, q);
        std::vector<double> x = linspace_points(s, 37);
        // also test exactly at the turning point
        if (const auto x0 = turning_point_m(s, f)) x.push_back(*x0);
        const Tone tone{f, 1, 0};
        for (const Normalise normalise : {Normalise::drive, Normalise::peak}) {
          const Field field = evaluate(s, {&tone, 1}, x, Model::mode, normalise);
          CHECK(finite(field));
          CHECK(std::isfinite(describe(s, {&tone, 1}, field).error_bound));
        }
      }
    }
  }
}

TEST_CASE("below the cut-off, and with strong loss, the field says why there is no last maximum",
          "[physics]") {
  Surface s = seed_brass();
  const ToneInfo below = tone_info(s, 6000);
  CHECK_FALSE(below.turning_point_m);
  CHECK_FALSE(below.last_peak_m);
  CHECK(below.no_peak_reason.find("no smooth zone") != std::string::npos);
  CHECK_THROWS_AS(drive_amplitude_m(s, 6000, 1e-6), std::domain_error);
  s.quality_factor = 5;
  s.taper = LinearTaper{0.03, 0.02};
  s.length_m = 1.5;
  const ToneInfo lossy = tone_info(s, 8000);
  CHECK_FALSE(lossy.last_peak_m);
  CHECK(lossy.no_peak_reason.find("loss") != std::string::npos);
}

TEST_CASE("near a zero of v(0), the conditioning number and a warning report it", "[physics]") {
  const Surface s = seed_brass();
  const double resonance = nearest_resonance_Hz(s, 19600).value();
  const Tone tone{resonance * (1 + 1e-7), 1, 0};
  const double x = 0.1;
  const Field field = evaluate(s, {&tone, 1}, {&x, 1}, Model::mode, Normalise::drive);
  CHECK(field.tones[0].info.conditioning > 1e4);
  bool warned = false;
  for (const Warning& one : describe(s, {&tone, 1}, field).warnings)
    warned = warned || one.code == "ill-conditioned";
  CHECK(warned);
  CHECK(evaluate(s, {&tone, 1}, {&x, 1}, Model::mode, Normalise::peak).tones[0].info.conditioning == 1);
}

TEST_CASE("drive_amplitude_m gives every boundary the same displacement at its last maximum", "[physics]") {
  for (const Surface& s : {aluminium_plate(), [] {
                             Surface b = seed_brass();
                             b.quality_factor = 60;
                             return b;
                           }()}) {
    for (const double f : {24e3, 31e3, 38.7e3, 44.9e3}) {
      const Tone tone{f, drive_amplitude_m(s, f, 1e-6), 0};
      const double x = tone_info(s, f).last_peak_m.value();
      const Field mode = evaluate(s, {&tone, 1}, {&x, 1}, Model::mode, Normalise::none);
      CHECK(std::abs(20 * std::log10(mode.amplitude[0] / 1e-6)) < 1e-9);
    }
  }
}

TEST_CASE("impossible requests are refused, and the message names the quantity", "[physics]") {
  const Surface s = seed_brass();
  const Tone tone{20e3, 1, 0}, silent{20e3, 0, 0};
  const double x = 0.1, outside = 0.31;
  CHECK_THROWS_AS(evaluate(s, {&tone, 1}, {&outside, 1}, Model::mode, Normalise::peak),
                  std::invalid_argument);
  CHECK_THROWS_AS(evaluate(s, {&tone, 1}, {&x, 1}, Model::edge, Normalise::peak), std::invalid_argument);
  CHECK_THROWS_AS(evaluate(s, {&silent, 1}, {&x, 1}, Model::mode, Normalise::peak), std::invalid_argument);
  CHECK_THROWS_AS(evaluate(s, {}, {&x, 1}, Model::mode, Normalise::peak), std::invalid_argument);
}
