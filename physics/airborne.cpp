#include "physics/airborne.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/instruction_sets.hpp"
#include "physics/statement.hpp"
#include "physics/taper.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {
namespace {

// Number of Gauss-Legendre nodes per half wavelength in air along the strip, and per half-width across it. In
// the plane y = 0, paths from the edge of the strip are at most half a wavelength longer than those from its
// centre (see loudest_sound()), so a few nodes are enough there.
constexpr int nodes_along = 4, nodes_across = 12, nodes_across_in_plane = 4;
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

/// Sources in the form in which add_paths() reads them, padded with silent ones to whole groups of `lanes`.
constexpr std::size_t lanes = 8;
struct Sources {
  std::vector<double> x_m, y_m, real, imaginary;

  explicit Sources(std::span<const SoundSource> sources) {
    const std::size_t size = (sources.size() + lanes - 1) / lanes * lanes;
    for (auto* one : {&x_m, &y_m, &real, &imaginary}) one->assign(size, 0);
    for (std::size_t i = 0; i < size && !sources.empty(); ++i) {
      const auto& source = sources[std::min(i, sources.size() - 1)];
      x_m[i] = source.x_m, y_m[i] = source.y_m;
      if (i < sources.size()) real[i] = source.volume_m3.real(), imaginary[i] = source.volume_m3.imag();
    }
  }
};

/// Returns the sum of volume exp(-2 pi i waves_per_m R) / R over the sources. The loops are written for
/// vector instructions, and always add in the same order. Sine and cosine of twice an angle below a quarter
/// turn follow from Taylor's series, which end where a term is below 1e-10.
TURNPOINT_CLONES
void add_paths(const double* __restrict x, const double* __restrict y, const double* __restrict real,
               const double* __restrict imaginary, std::size_t n, const Place& place, double waves_per_m,
               double* __restrict sum) {
  double re[lanes] = {}, im[lanes] = {};
  const double px = place.x_m, py = place.y_m, z2 = place.z_m * place.z_m;
  for (std::size_t i = 0; i < n; i += lanes) {
    double a[lanes], b[lanes];
    for (std::size_t l = 0; l < lanes; ++l) {
      const double dx = px - x[i + l], dy = py - y[i + l];
      const double r = std::sqrt(dx * dx + dy * dy + z2), turns = waves_per_m * r;
      const double u = std::numbers::pi * (turns - std::nearbyint(turns)), q = -u * u;
      const double sine =
          u * (1 + q / 6 *
                       (1 + q / 20 *
                                (1 + q / 42 * (1 + q / 72 * (1 + q / 110 * (1 + q / 156 * (1 + q / 210)))))));
      const double cosine =
          1 +
          q / 2 *
              (1 + q / 12 *
                       (1 + q / 30 *
                                (1 + q / 56 * (1 + q / 90 * (1 + q / 132 * (1 + q / 182 * (1 + q / 240)))))));
      const double c = (1 - 2 * sine * sine) / r, s = -2 * sine * cosine / r;
      a[l] = real[i + l] * c - imaginary[i + l] * s;
      b[l] = real[i + l] * s + imaginary[i + l] * c;
    }
    for (std::size_t l = 0; l < lanes; ++l) re[l] += a[l], im[l] += b[l];
  }
  sum[0] = ((re[0] + re[1]) + (re[2] + re[3])) + ((re[4] + re[5]) + (re[6] + re[7]));
  sum[1] = ((im[0] + im[1]) + (im[2] + im[3])) + ((im[4] + im[5]) + (im[6] + im[7]));
}

std::vector<SoundSource> sources_of(const Surface& surface, const Tone& tone, Model model, const Air& air,
                                    int count_across) {
  validate(surface, {&tone, 1});
  validate(air);
  const double half_waves = 2 * surface.length_m * tone.frequency_Hz / air.speed_m_s;
  require(half_waves <= 2000, "half wavelengths in air along the surface", half_waves, "at most 2000");
  const Taper taper(surface);
  const bool clamped_plate = Dispersion(surface).clamped_bending();
  const Quadrature along = gauss_legendre(nodes_along), across = gauss_legendre(count_across);
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
  sources.reserve(2 * static_cast<std::size_t>(count_across) * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = taper.half_width_m(x[i]);
    for (int j = 0; j < count_across; ++j) {
      const double eta = across.x[j];
      const auto volume =
          field.front().v[i] * (dx[i] * across.w[j] * w * transverse_shape(clamped_plate, eta));
      sources.push_back({x[i], eta * w, volume});
      sources.push_back({x[i], -eta * w, volume});
    }
  }
  return sources;
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
  const double omega = 2 * std::numbers::pi * frequency_Hz;
  const double factor = -air.density_kg_m3 * omega * omega / (2 * std::numbers::pi);
  std::vector<std::complex<double>> pressure;
  pressure.reserve(places.size());
  const Sources all(sources);
  for (const Place& place : places) {
    double sum[2];
    add_paths(all.x_m.data(), all.y_m.data(), all.real.data(), all.imaginary.data(), all.x_m.size(), place,
              frequency_Hz / air.speed_m_s, sum);
    pressure.emplace_back(factor * sum[0], factor * sum[1]);
  }
  return pressure;
}

std::vector<SoundSource> sound_sources(const Surface& surface, const Tone& tone, Model model,
                                       const Air& air) {
  return sources_of(surface, tone, model, air, nodes_across);
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
  auto sources = sources_of(surface, tone, model, air, nodes_across_in_plane);
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
