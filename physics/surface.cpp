#include "physics/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "physics/gate.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Handbook values. The yield strengths are those of hard commercial tempers.
constexpr std::array materials{
    Material{"aluminium", 2700, 69e9, 0.33, 0.28e9}, Material{"brass", 8110, 100e9, 0.34, 0.75e9},
    Material{"steel", 7850, 205e9, 0.29, 1.0e9},     Material{"stainless", 8000, 193e9, 0.29, 1.0e9},
    Material{"titanium", 4430, 114e9, 0.34, 0.88e9}, Material{"copper", 8940, 117e9, 0.34, 0.33e9},
    Material{"glass", 2500, 70e9, 0.22, 0.05e9},     Material{"polyimide", 1420, 2.5e9, 0.34, 0.069e9},
    Material{"rubber", 1100, 2e6, 0.49, 10e6}};

// Refuses a taper that narrows too slowly for a number, or faster than a surface can.
void require_fall(const char* quantity, double half_width_per_length) {
  require(half_width_per_length >= 1e-9 && half_width_per_length <= 1e3, quantity, half_width_per_length,
          "1e-9 to 1000");
}

void require_half_widths(double count) {
  require(count <= most_half_widths, "length in half-widths", count, "at most 20 000");
}

void validate_linear(const LinearTaper& taper, double length_m) {
  require_size("half_width_m", taper.half_width_m);
  require(taper.slope >= 0 && taper.slope <= 1, "slope", taper.slope, "0 to 1");
  if (taper.slope > 0) require_fall("slope", taper.slope);
  const double end = taper.half_width_m - taper.slope * length_m;
  require(end >= -1e-9 * taper.half_width_m, "length_m", length_m,
          "not beyond the apex, half_width_m / slope");
  if (end > 0.5 * taper.half_width_m) require_half_widths(length_m / taper.half_width_m);
}

void validate_exponential(const ExponentialTaper& taper, double length_m) {
  require_size("half_width_m", taper.half_width_m);
  require_size("decay_length_m", taper.decay_length_m);
  require_fall("half_width_m / decay_length_m", taper.half_width_m / taper.decay_length_m);
  require(length_m <= 100 * taper.decay_length_m, "length_m", length_m, "at most 100 decay lengths");
}

void validate_table(const TabulatedTaper& taper, double length_m) {
  const auto& points = taper.points;
  require(points.size() >= 2 && points.size() <= most_taper_points, "number of taper points",
          static_cast<double>(points.size()), "2 to 2000");
  require(points.front().x_m == 0, "x_m of the first taper point", points.front().x_m, "0");
  double half_widths = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    require_size("half_width_m of a taper point", points[i].half_width_m);
    if (i == 0) continue;
    const double step = points[i].x_m - points[i - 1].x_m;
    require(step >= least_taper_step * length_m && points[i].x_m <= largest_size, "x_m of a taper point",
            points[i].x_m, "ascending, in steps of at least 1e-7 of the length");
    const double fall = points[i - 1].half_width_m - points[i].half_width_m;
    require(fall > 0, "half_width_m of a taper point", points[i].half_width_m, "falling from point to point");
    require_fall("slope of a taper", fall / step);
    half_widths +=
        std::min(step / points[i].half_width_m, step / fall * std::log1p(fall / points[i].half_width_m));
  }
  require(points.back().x_m >= length_m * (1 - 1e-12), "x_m of the last taper point", points.back().x_m,
          "at or beyond length_m");
  require_half_widths(half_widths);
}

void validate_taper(const Surface& s) {
  if (const auto* linear = std::get_if<LinearTaper>(&s.taper)) {
    validate_linear(*linear, s.length_m);
  } else if (const auto* exponential = std::get_if<ExponentialTaper>(&s.taper)) {
    validate_exponential(*exponential, s.length_m);
  } else {
    validate_table(std::get<TabulatedTaper>(s.taper), s.length_m);
  }
}

double widest_m(const TabulatedTaper& taper) { return taper.points.front().half_width_m; }
template <class Form>
double widest_m(const Form& taper) {
  return taper.half_width_m;
}

void validate_theory(const Surface& s) {
  if (s.theory == PlateTheory::kirchhoff) return;
  if (s.tension_Pa > 0 || s.edges != Edges::clamped) {
    throw std::invalid_argument("plate theory is " + std::string(name(s.theory)) +
                                "; allowed for a clamped plate without tension only");
  }
  require(s.poisson >= 0 && s.poisson <= 0.49, "poisson", s.poisson,
          "0 to 0.49 for the plate theories mindlin and elastic");
}

}  // namespace

std::string_view name(PlateTheory theory) {
  switch (theory) {
    case PlateTheory::kirchhoff:
      return "kirchhoff";
    case PlateTheory::mindlin:
      return "mindlin";
    case PlateTheory::elastic:
      break;
  }
  return "elastic";
}

PlateTheory parse_plate_theory(std::string_view text) {
  for (const auto theory : {PlateTheory::kirchhoff, PlateTheory::mindlin, PlateTheory::elastic}) {
    if (text == name(theory)) return theory;
  }
  throw std::invalid_argument("plate theory \"" + std::string(text) +
                              "\" is not known; allowed: kirchhoff, mindlin, elastic");
}

std::optional<Material> find_material(std::string_view wanted) {
  for (const Material& material : materials) {
    if (material.name == wanted) return material;
  }
  return std::nullopt;
}

void validate(const Surface& s) {
  require_size("density_kg_m3", s.density_kg_m3);
  require_size_or_0("tension_Pa", s.tension_Pa);
  require_size("thickness_m", s.thickness_m);
  require_size("length_m", s.length_m);
  require(s.quality_factor >= 1, "quality_factor", s.quality_factor, "1 to infinity");
  if (s.modulus_Pa) require_size("modulus_Pa", *s.modulus_Pa);
  require(s.poisson >= -0.9 && s.poisson <= 0.5, "poisson", s.poisson, "-0.9 to 0.5");
  if (s.yield_strength_Pa) require_size("yield_strength_Pa", *s.yield_strength_Pa);
  require(std::abs(s.expansion_per_K) <= 1, "expansion_per_K", s.expansion_per_K, "-1 to 1");
  require(std::abs(s.modulus_per_K) <= 1, "modulus_per_K", s.modulus_per_K, "-1 to 1");
  const ParameterSd& sd = s.sd;
  for (const double one : {sd.density_kg_m3, sd.tension_Pa, sd.thickness_m, sd.modulus_Pa, sd.half_width_m,
                           sd.slope, sd.decay_length_m, sd.clamp_line_m, sd.temperature_K, sd.quality_factor})
    require_size_or_0("standard deviation of a parameter", one);
  for (const Correlation& c : s.correlations)
    require(std::abs(c.coefficient) <= 1, "correlation", c.coefficient, "-1 to 1");
  validate_taper(s);
  if (s.tension_Pa == 0 && s.bending == Bending::off) {
    throw std::invalid_argument("tension_Pa is 0 while bending is off; allowed: tension above 0, or bending");
  }
  if ((s.tension_Pa == 0 || s.bending == Bending::on) && !s.modulus_Pa) {
    throw std::invalid_argument(
        "modulus_Pa is missing; it is required for a plate (tension_Pa = 0) and whenever bending is on");
  }
  validate_theory(s);
  const double w0 = std::visit([](const auto& taper) { return widest_m(taper); }, s.taper);
  if (bending_modelled(s))
    require(s.thickness_m >= 1e-9 * w0 && s.thickness_m <= 2 * w0, "thickness_m", s.thickness_m,
            "1e-9 to 2 half-widths of the drive edge where bending is modelled");
}

double half_width_m(const Surface& surface, double x_m) {
  require_on_surface(surface, "x_m", x_m);
  const double w = Taper(surface).half_width_m(x_m);
  require(std::isfinite(w), "half_width_m", w, "finite");
  return w;
}

std::optional<double> bending_stiffness_N_m(const Surface& s) {
  if (!s.modulus_Pa) return std::nullopt;
  const double stiffness =
      *s.modulus_Pa * s.thickness_m * s.thickness_m * s.thickness_m / (12 * (1 - s.poisson * s.poisson));
  require(std::isfinite(stiffness), "bending stiffness", stiffness, "finite");
  return stiffness;
}

double line_tension_N_per_m(const Surface& s) {
  const double tension = s.tension_Pa * s.thickness_m;
  require(std::isfinite(tension), "line tension", tension, "finite");
  return tension;
}

double wave_speed_m_s(const Surface& s) {
  const double speed = std::sqrt(s.tension_Pa / s.density_kg_m3);
  require(std::isfinite(speed), "wave speed", speed, "finite");
  return speed;
}

bool bending_modelled(const Surface& s) {
  if (s.bending != Bending::automatic) return s.bending == Bending::on;
  if (s.tension_Pa == 0) return true;
  const auto stiffness = bending_stiffness_N_m(s);
  if (!stiffness) return false;
  // Half-width at 90 % of the length. No boundary is expected farther out, where the surface is narrower.
  const double w = Taper(s).half_width_m(0.9 * s.length_m);
  const double k = std::numbers::pi / (2 * w);
  const double ratio = *stiffness * k * k / line_tension_N_per_m(s);
  // Bending shifts a cut-off. With simply supported sides, the frequency rises by the fraction ratio/2. With
  // clamped sides, the membrane's half-width shrinks by sqrt(D/N).
  return s.edges == Edges::clamped ? std::sqrt(ratio) > 0.0157 : ratio > 0.01;
}

Surface seed_brass() {
  Surface s;
  s.density_kg_m3 = 8110;
  s.tension_Pa = 5.12e9;
  s.thickness_m = 0.05e-3;
  s.length_m = 0.3;
  s.quality_factor = infinity;
  s.taper = LinearTaper{0.03, 0.1};
  return s;
}

Surface aluminium_plate() {
  Surface s;
  s.density_kg_m3 = 2700;
  s.modulus_Pa = 69e9;
  s.poisson = 0.33;
  s.yield_strength_Pa = 0.28e9;
  s.thickness_m = 2e-3;
  s.length_m = 0.3;
  s.quality_factor = 30;
  s.taper = LinearTaper{0.014, 0.03};
  s.edges = Edges::clamped;
  return s;
}

}  // namespace turnpoint::physics
