#include "physics/airborne.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/statement.hpp"
#include "physics/taper.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {
namespace {

// Number of Gauss-Legendre nodes per half wavelength in air along the strip, and per half-width across it.
constexpr int nodes_along = 4, nodes_across = 12;
constexpr double reference_Pa = 20e-6;
constexpr double most_paths = 1e8;  // number of sources times places, a second's work

void validate(const Air& air) {
  require_size("density_kg_m3 of air", air.density_kg_m3);
  require_size("speed_m_s of air", air.speed_m_s);
}

// Displacement across the strip divided by the displacement of its centre, at eta = y / W, with W the
// half-width.
double transverse_shape(bool clamped_plate, double eta) {
  if (!clamped_plate) return std::cos(0.5 * std::numbers::pi * eta);
  constexpr double b = 2.36502;  // the root of tan b + tanh b = 0
  static const double at_edge = std::cos(b) / std::cosh(b);
  return (std::cos(b * eta) - at_edge * std::cosh(b * eta)) / (1 - at_edge);
}

// Places above the strip, all at the distance `distance_m` from the centre line: a quarter circle around each
// end of the line, and a straight line between them.
std::vector<Place> places_around(double length_m, double distance_m, double step_m) {
  const double arc = 0.5 * std::numbers::pi * distance_m, whole = length_m + 2 * arc;
  const int steps = static_cast<int>(std::ceil(whole / step_m));
  std::vector<Place> places;
  for (int i = 0; i <= steps; ++i) {
    const double s = whole * i / steps;
    if (s < arc)
      places.push_back({-distance_m * std::cos(s / distance_m), 0, distance_m * std::sin(s / distance_m)});
    else if (s <= arc + length_m)
      places.push_back({s - arc, 0, distance_m});
    else
      places.push_back({length_m + distance_m * std::sin((s - arc - length_m) / distance_m), 0,
                        distance_m * std::cos((s - arc - length_m) / distance_m)});
  }
  return places;
}

}  // namespace

AirLoad air_load(const Surface& surface, double f, const Air& air) {
  validate(surface, f);
  validate(air);
  const double omega = 2 * std::numbers::pi * f, k = wavenumber_per_m(surface, f);
  const double in_air = omega / air.speed_m_s, mass = surface.density_kg_m3 * surface.thickness_m;
  const double squares = (in_air - k) * (in_air + k);
  // at the speed of sound itself, an infinite plane would be held still
  const double along = std::sqrt(std::max(std::abs(squares), 1e-12 * k * k));
  AirLoad load;
  if (squares > 0)
    load.quality_factor = omega * mass * along / in_air / (2 * air.density_kg_m3 * air.speed_m_s);
  else
    load.mass_share = 2 * air.density_kg_m3 / (along * mass);
  return load;
}

std::vector<std::complex<double>> radiated_pressure_Pa(std::span<const SoundSource> sources,
                                                       double frequency_Hz, std::span<const Place> places,
                                                       const Air& air) {
  require_size("frequency_Hz", frequency_Hz);
  validate(air);
  require(static_cast<double>(sources.size()) * static_cast<double>(places.size()) <= most_paths,
          "number of sources times places", static_cast<double>(sources.size() * places.size()),
          "at most 1e8");
  const double omega = 2 * std::numbers::pi * frequency_Hz, k = omega / air.speed_m_s;
  const double factor = -air.density_kg_m3 * omega * omega / (2 * std::numbers::pi);
  std::vector<std::complex<double>> pressure;
  pressure.reserve(places.size());
  for (const Place& place : places) {
    double real = 0, imaginary = 0;
    for (const SoundSource& source : sources) {
      const double dx = place.x_m - source.x_m, dy = place.y_m - source.y_m;
      const double r = std::sqrt(dx * dx + dy * dy + place.z_m * place.z_m);
      const double c = std::cos(k * r) / r, s = -std::sin(k * r) / r;
      real += source.volume_m3.real() * c - source.volume_m3.imag() * s;
      imaginary += source.volume_m3.real() * s + source.volume_m3.imag() * c;
    }
    pressure.emplace_back(factor * real, factor * imaginary);
  }
  return pressure;
}

std::vector<SoundSource> sound_sources(const Surface& surface, const Tone& tone, Model model,
                                       const Air& air) {
  validate(surface, {&tone, 1});
  validate(air);
  const double half_waves = 2 * surface.length_m * tone.frequency_Hz / air.speed_m_s;
  require(half_waves <= 2000, "half wavelengths in air along the surface", half_waves, "at most 2000");
  const Taper taper(surface);
  const bool clamped_plate = Dispersion(surface).clamped_bending();
  const Quadrature along = gauss_legendre(nodes_along), across = gauss_legendre(nodes_across);
  const int pieces = std::max(1, static_cast<int>(std::ceil(half_waves)));
  const double piece_m = surface.length_m / pieces;
  std::vector<double> x, dx;
  for (int piece = 0; piece < pieces; ++piece)
    for (int i = 0; i < nodes_along; ++i) {
      x.push_back((piece + along.x[i]) * piece_m);
      dx.push_back(along.w[i] * piece_m);
    }
  const auto field = evaluate_tones(surface, {&tone, 1}, x, model, Normalise::none);
  std::vector<SoundSource> sources;
  sources.reserve(2 * nodes_across * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = taper.half_width_m(x[i]);
    for (int j = 0; j < nodes_across; ++j) {
      const double eta = across.x[j];
      const auto volume =
          field.front().v[i] * (dx[i] * across.w[j] * w * transverse_shape(clamped_plate, eta));
      sources.push_back({x[i], eta * w, volume});
      sources.push_back({x[i], -eta * w, volume});
    }
  }
  return sources;
}

LoudestSound loudest_sound(const Surface& surface, const Tone& tone, Model model, double distance_m,
                           const Air& air) {
  validate(surface, {&tone, 1});
  validate(air);
  require_size("distance_m", distance_m);
  const double wave_m = air.speed_m_s / tone.frequency_Hz, half_width = half_width_m(surface, 0);
  if (!(distance_m > wave_m && half_width * half_width < wave_m * distance_m))
    throw std::invalid_argument("sound: the distance must be above a wavelength in air (" +
                                StatementValue(1e3 * wave_m).text + " mm) and " +
                                StatementValue(1e3 * half_width * half_width / wave_m).text + " mm");
  auto sources = sound_sources(surface, tone, model, air);
  // All places are in the plane y = 0, so each has the same distance from both halves of the strip. It is
  // enough to add up one half and count it twice.
  std::erase_if(sources, [](const SoundSource& source) { return source.y_m < 0; });
  for (SoundSource& source : sources) source.volume_m3 *= 2;
  const double step_m = std::min(5e-3, 0.5 * wave_m);
  const double places_needed = (surface.length_m + std::numbers::pi * distance_m) / step_m;
  require(places_needed * static_cast<double>(sources.size()) <= most_paths, "distance_m", distance_m,
          "so near that at most 1e8 paths of sound are added up");
  const auto places = places_around(surface.length_m, distance_m, step_m);
  const auto pressure = radiated_pressure_Pa(sources, tone.frequency_Hz, places, air);
  LoudestSound loudest{std::numeric_limits<double>::lowest(), places.front()};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double rms = std::abs(pressure[i]) / std::numbers::sqrt2;
    if (!(rms > 0)) continue;
    const double level = 20 * std::log10(rms / reference_Pa);
    if (level > loudest.level_dB) loudest = {level, places[i]};
  }
  return loudest;
}

}  // namespace turnpoint::physics
