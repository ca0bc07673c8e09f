#include "physics/airborne.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/taper.hpp"
#include "physics/warning.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

constexpr double pi = std::numbers::pi;

/// Returns the sources of a round piston of radius `a_m` that moves by `u_m`: rings of equal width, in which
/// the sources are nearly equally far from each other.
std::vector<SoundSource> piston(double a_m, double u_m, int rings) {
  std::vector<SoundSource> sources;
  for (int ring = 0; ring < rings; ++ring) {
    const double inner = a_m * ring / rings, outer = a_m * (ring + 1) / rings, middle = 0.5 * (inner + outer);
    const int count = 6 * ring + 6;
    const double area = pi * (outer * outer - inner * inner) / count;
    for (int k = 0; k < count; ++k)
      sources.push_back(
          {middle * std::cos(2 * pi * k / count), middle * std::sin(2 * pi * k / count), u_m * area});
  }
  return sources;
}

/// Computes Rayleigh's integral by the midpoint rule on a fine grid. The shape across the strip comes from
/// the equation of the first mode of a clamped strip.
std::complex<double> by_midpoints(const Surface& surface, const Tone& tone, Model model, const Place& place) {
  constexpr int across = 400;
  const Air air;
  const int along = 3000;
  const double omega = 2 * pi * tone.frequency_Hz, k = omega / air.speed_m_s, b = 2.3650203724313523;
  std::vector<double> x;
  for (int i = 0; i < along; ++i) x.push_back(surface.length_m * (i + 0.5) / along);
  const auto v = evaluate_tones(surface, {&tone, 1}, x, model, Normalise::none).front().v;
  const auto shape = [&](double eta) {
    if (surface.tension_Pa > 0) return std::cos(pi / 2 * eta);
    return (std::cosh(b) * std::cos(b * eta) - std::cos(b) * std::cosh(b * eta)) /
           (std::cosh(b) - std::cos(b));
  };
  std::complex<double> sum;
  for (int i = 0; i < along; ++i) {
    const double w = half_width_m(surface, x[i]);
    for (int j = 0; j < across; ++j) {
      const double eta = -1 + (j + 0.5) * 2 / across;
      const double r = std::hypot(place.x_m - x[i], place.y_m - eta * w, place.z_m);
      sum += v[i] * shape(eta) * (surface.length_m / along) * (2 * w / across) * std::polar(1 / r, -k * r);
    }
  }
  return -air.density_kg_m3 * omega * omega / (2 * pi) * sum;
}

}  // namespace

TEST_CASE("the sound on a piston's axis agrees with the closed form, near and far", "[physics][airborne]") {
  const double f = 30000, a = 0.02, u = 1e-6;
  const Air air;
  const double omega = 2 * pi * f, k = omega / air.speed_m_s;
  const auto sources = piston(a, u, 120);
  for (const double z : {0.01, 0.05, 0.3, 2.0}) {
    const Place place{0, 0, z};
    const double expected = 2 * air.density_kg_m3 * air.speed_m_s * omega * u *
                            std::abs(std::sin(k / 2 * (std::hypot(z, a) - z)));
    CHECK(std::abs(radiated_pressure_Pa(sources, f, {&place, 1}).front()) == Approx(expected).epsilon(2e-3));
  }
  const Place far{0, 0, 2};
  CHECK_THROWS_AS(radiated_pressure_Pa(sources, 0, {&far, 1}), std::invalid_argument);
}

TEST_CASE("the integral over a strip agrees with one on a far finer grid, at the ear and close to the strip",
          "[physics][airborne]") {
  const auto plate = aluminium_plate();
  for (const double f : {22400.0, 45000.0}) {
    const Tone tone{f, 1e-6, 0.3};
    const auto sources = sound_sources(plate, tone, Model::mode);
    for (const Place& place : {Place{0.15, 0, 0.4}, Place{-0.2, 0.1, 0.3}, Place{0.3, -0.2, 0.05}}) {
      const auto expected = by_midpoints(plate, tone, Model::mode, place);
      const auto found = radiated_pressure_Pa(sources, f, {&place, 1}).front();
      INFO(f << " Hz at " << place.x_m << ", " << place.y_m << ", " << place.z_m);
      CHECK(std::abs(found - expected) < 1e-2 * std::abs(expected) + 1e-4);
    }
  }
}

TEST_CASE(
    "no place at the given distance or beyond is more than 0.3 dB louder than the loudest place that is "
    "reported",
    "[physics][airborne]") {
  const auto plate = aluminium_plate();
  const double distance = 0.4;
  for (const double f : {22400.0, 31000.0, 45000.0}) {
    const Tone tone{f, 1e-6, 0};
    const auto loudest = loudest_sound(plate, tone, Model::mode, distance);
    const auto sources = sound_sources(plate, tone, Model::mode);
    std::vector<Place> places;
    std::uint64_t state = 1;
    const auto draw = [&state] {
      state = state * 6364136223846793005u + 1442695040888963407u;
      return static_cast<double>(state >> 11) * 0x1p-53;
    };
    while (places.size() < 1500) {
      const Place place{-1 + 2.5 * draw(), -0.6 + 1.2 * draw(), 1.2 * draw()};
      const double nearest = std::clamp(place.x_m, 0.0, plate.length_m);
      if (std::hypot(place.x_m - nearest, place.y_m, place.z_m) >= distance) places.push_back(place);
    }
    // Also compare places around the loudest one, along the strip. None may be louder.
    for (int i = -600; i <= 600; ++i)
      places.push_back({loudest.place.x_m + 1e-4 * i, 0, std::max(loudest.place.z_m, distance)});
    double most = 0;
    for (const auto& p : radiated_pressure_Pa(sources, f, places)) most = std::max(most, std::abs(p));
    const double level = 20 * std::log10(most / std::numbers::sqrt2 / 20e-6);
    INFO(f << " Hz: " << loudest.level_dB << " dB at x " << loudest.place.x_m << ", z " << loudest.place.z_m);
    CHECK(level < loudest.level_dB + 0.3);
    CHECK(level > loudest.level_dB - 6);
  }
}

TEST_CASE(
    "the sound level follows the displacement, and a distance too short for the first Fresnel zone is "
    "refused",
    "[physics][airborne]") {
  const auto plate = aluminium_plate();
  const auto soft = loudest_sound(plate, {30000, 1e-7, 0}, Model::mode, 0.4),
             loud = loudest_sound(plate, {30000, 1e-6, 0}, Model::mode, 0.4);
  CHECK(loud.level_dB - soft.level_dB == Approx(20).margin(1e-9));
  CHECK_THROWS_AS(loudest_sound(plate, {30000, 1e-6, 0}, Model::mode, 0.011), std::invalid_argument);
}

TEST_CASE("the air damps a fast wave and loads a slow one as Rayleigh's integral over a large patch says",
          "[physics]") {
  // A square patch of an infinite plane on which a wave runs along x, its edges faded out. Sources are 1/8 of
  // the shorter wavelength apart.
  const auto patch = [](double k, double spacing_m, double half_m) {
    std::vector<SoundSource> sources;
    const auto fade = [half_m](double at) { return std::pow(std::cos(0.5 * pi * at / half_m), 2); };
    for (double x = -half_m; x <= half_m; x += spacing_m)
      for (double y = -half_m; y <= half_m; y += spacing_m)
        sources.push_back({x, y, std::polar(1e-6 * fade(x) * fade(y) * spacing_m * spacing_m, -k * x)});
    return sources;
  };
  const Air air;
  {  // the 1998 paper's brass: radiated power against the energy of the motion
    const Surface s = seed_brass();
    const double f = 19600, omega = 2 * pi * f, k = omega / wave_speed_m_s(s), half_m = 0.12, far_m = 20;
    double power = 0;
    constexpr int rings = 60, around = 48;
    const auto sources = patch(k, 2.5e-3, half_m);
    for (int i = 0; i < rings; ++i) {
      const double theta = 0.5 * pi * (i + 0.5) / rings;
      std::vector<Place> places;
      for (int j = 0; j < around; ++j) {
        const double phi = 2 * pi * (j + 0.5) / around;
        places.push_back({far_m * std::sin(theta) * std::cos(phi), far_m * std::sin(theta) * std::sin(phi),
                          far_m * std::cos(theta)});
      }
      for (const auto& p : radiated_pressure_Pa(sources, f, places))
        power += std::norm(p) / (2 * air.density_kg_m3 * air.speed_m_s) * far_m * far_m * std::sin(theta) *
                 (0.5 * pi / rings) * (2 * pi / around);
    }
    // the mean of the fourth power of a cosine is 3/8, in both directions
    const double area = std::pow(2 * half_m * 3 / 8, 2);
    const double energy = 0.5 * s.density_kg_m3 * s.thickness_m * omega * omega * 1e-12 * area;
    const double by_integral = omega * energy / (2 * power);  // both faces radiate
    CHECK(air_load(s, f).quality_factor.value() == Approx(by_integral).epsilon(0.02));
    CHECK(air_load(s, f).mass_share == 0);
    CHECK(air_load(s, 8000).quality_factor.value() == Approx(22).margin(0.5));
    CHECK(air_load(s, f).quality_factor.value() == Approx(54).margin(0.5));
    CHECK(air_load(s, 45000).quality_factor.value() == Approx(125).margin(0.5));
    CHECK(air_load(aluminium_plate(), 22400).quality_factor.value() > 750);
  }
  {  // a slow membrane: the pressure above it is that of a mass
    Surface s = seed_brass();
    s.density_kg_m3 = 1000, s.tension_Pa = 17640, s.thickness_m = 0.02e-3;
    s.taper = LinearTaper{0.05, 0.1};
    const double f = 3000, omega = 2 * pi * f, k = omega / wave_speed_m_s(s);
    const double in_air = omega / air.speed_m_s, decay = std::sqrt(k * k - in_air * in_air);
    const double wave_m = 2 * pi / k, above_m = 0.5 / decay;
    const Place place{0, 0, above_m};
    const auto p = radiated_pressure_Pa(patch(k, wave_m / 40, 6 * wave_m), f, {&place, 1}).front();
    const double mass = std::abs(p) * std::exp(decay * above_m) / (omega * omega * 1e-6);
    CHECK(2 * mass / (s.density_kg_m3 * s.thickness_m) == Approx(air_load(s, f).mass_share).epsilon(0.03));
    CHECK_FALSE(air_load(s, f).quality_factor);
    CHECK(air_load(s, 30).mass_share == Approx(2.7).margin(0.05));
  }
}

TEST_CASE("a stated quality factor above what radiation leaves, and air heavier than a tenth, give warnings",
          "[physics]") {
  const auto warns = [](const Surface& s, double f, const char* code) {
    const Tone tone{f, 1, 0};
    const auto all = tone_warnings(s, {&tone, 1});
    return std::ranges::any_of(all, [&](const Warning& w) { return w.code == code; });
  };
  Surface s = seed_brass();
  s.quality_factor = 100;
  CHECK(warns(s, 19600, "air-loss"));
  CHECK_FALSE(warns(s, 45000, "air-loss"));
  s.quality_factor = 50;
  CHECK_FALSE(warns(s, 19600, "air-loss"));
  s.tension_Pa = 17640, s.density_kg_m3 = 1000, s.thickness_m = 0.02e-3;
  CHECK(warns(s, 30, "air-mass"));
}
