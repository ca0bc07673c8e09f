#include "physics/surface.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

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

void require(bool holds, const char* quantity, double value, const char* allowed) {
  if (holds) return;
  std::ostringstream text;
  text << quantity << " is " << value << "; allowed: " << allowed;
  throw std::invalid_argument(text.str());
}

bool finite_positive(double value) { return std::isfinite(value) && value > 0; }

void validate_linear(const LinearTaper& taper, double length_m) {
  require(finite_positive(taper.half_width_m), "half_width_m", taper.half_width_m, "above 0");
  require(taper.slope >= 0 && taper.slope <= 1, "slope", taper.slope, "0 to 1");
  const double end = taper.half_width_m - taper.slope * length_m;
  require(end >= -1e-9 * taper.half_width_m, "length_m", length_m,
          "not beyond the apex, half_width_m / slope");
}

void validate_table(const TabulatedTaper& taper, double length_m) {
  const auto& points = taper.points;
  require(points.size() >= 2, "number of taper points", static_cast<double>(points.size()), "2 or more");
  require(points.front().x_m == 0, "x_m of the first taper point", points.front().x_m, "0");
  for (std::size_t i = 0; i < points.size(); ++i) {
    require(finite_positive(points[i].half_width_m), "half_width_m of a taper point", points[i].half_width_m,
            "above 0");
    if (i == 0) continue;
    require(points[i].x_m > points[i - 1].x_m, "x_m of a taper point", points[i].x_m, "ascending");
    require(points[i].half_width_m < points[i - 1].half_width_m, "half_width_m of a taper point",
            points[i].half_width_m, "falling from point to point");
  }
  require(points.back().x_m >= length_m * (1 - 1e-12), "x_m of the last taper point", points.back().x_m,
          "at or beyond length_m");
}

void validate_taper(const Surface& surface) {
  if (const auto* linear = std::get_if<LinearTaper>(&surface.taper)) {
    validate_linear(*linear, surface.length_m);
  } else if (const auto* exponential = std::get_if<ExponentialTaper>(&surface.taper)) {
    require(finite_positive(exponential->half_width_m), "half_width_m", exponential->half_width_m, "above 0");
    require(finite_positive(exponential->decay_length_m), "decay_length_m", exponential->decay_length_m,
            "above 0");
    require(surface.length_m <= 100 * exponential->decay_length_m, "length_m", surface.length_m,
            "at most 100 decay lengths");
  } else {
    validate_table(std::get<TabulatedTaper>(surface.taper), surface.length_m);
  }
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
  require(finite_positive(s.density_kg_m3), "density_kg_m3", s.density_kg_m3, "above 0");
  require(std::isfinite(s.tension_Pa) && s.tension_Pa >= 0, "tension_Pa", s.tension_Pa, "0 or more");
  require(finite_positive(s.thickness_m), "thickness_m", s.thickness_m, "above 0");
  require(finite_positive(s.length_m), "length_m", s.length_m, "above 0");
  require(s.quality_factor >= 1, "quality_factor", s.quality_factor, "1 to infinity");
  if (s.modulus_Pa) require(finite_positive(*s.modulus_Pa), "modulus_Pa", *s.modulus_Pa, "above 0");
  require(s.poisson > -1 && s.poisson <= 0.5, "poisson", s.poisson, "above -1, at most 0.5");
  if (s.yield_strength_Pa) {
    require(finite_positive(*s.yield_strength_Pa), "yield_strength_Pa", *s.yield_strength_Pa, "above 0");
  }
  validate_taper(s);
  if (s.tension_Pa == 0 && s.bending == Bending::off) {
    throw std::invalid_argument("tension_Pa is 0 while bending is off; allowed: tension above 0, or bending");
  }
  if ((s.tension_Pa == 0 || s.bending == Bending::on) && !s.modulus_Pa) {
    throw std::invalid_argument(
        "modulus_Pa is missing; it is required for a plate (tension_Pa = 0) and whenever bending is on");
  }
  validate_theory(s);
}

double half_width_m(const Surface& surface, double x_m) { return Taper(surface).half_width_m(x_m); }

std::optional<double> bending_stiffness_N_m(const Surface& s) {
  if (!s.modulus_Pa) return std::nullopt;
  return *s.modulus_Pa * s.thickness_m * s.thickness_m * s.thickness_m / (12 * (1 - s.poisson * s.poisson));
}

double line_tension_N_per_m(const Surface& s) { return s.tension_Pa * s.thickness_m; }

double wave_speed_m_s(const Surface& s) { return std::sqrt(s.tension_Pa / s.density_kg_m3); }

bool bending_modelled(const Surface& s) {
  if (s.bending != Bending::automatic) return s.bending == Bending::on;
  if (s.tension_Pa == 0) return true;
  const auto stiffness = bending_stiffness_N_m(s);
  if (!stiffness) return false;
  // Half-width at 90 % of the length. No boundary is expected farther out, where the surface is narrower.
  const double w = half_width_m(s, 0.9 * s.length_m);
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
  s.quality_factor = 60;
  s.taper = LinearTaper{0.014, 0.03};
  s.edges = Edges::clamped;
  return s;
}

}  // namespace turnpoint::physics
