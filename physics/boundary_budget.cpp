#include "physics/boundary_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/gate.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

struct Entry {
  Parameter parameter;
  std::string_view name;
  double ParameterSd::*sd;
  ParameterUnit unit;
};

constexpr std::array entries{
    Entry{Parameter::density, "density", &ParameterSd::density_kg_m3, {"kg/m3", 1}},
    Entry{Parameter::tension, "tension", &ParameterSd::tension_Pa, {"MPa", 1e6}},
    Entry{Parameter::thickness, "thickness", &ParameterSd::thickness_m, {"mm", 1e-3}},
    Entry{Parameter::modulus, "modulus", &ParameterSd::modulus_Pa, {"GPa", 1e9}},
    Entry{Parameter::half_width, "half-width", &ParameterSd::half_width_m, {"mm", 1e-3}},
    Entry{Parameter::slope, "slope", &ParameterSd::slope, {"", 1}},
    Entry{Parameter::decay_length, "decay length", &ParameterSd::decay_length_m, {"mm", 1e-3}},
    Entry{Parameter::clamp_line, "clamp line", &ParameterSd::clamp_line_m, {"mm", 1e-3}},
    Entry{Parameter::temperature, "temperature", &ParameterSd::temperature_K, {"K", 1}}};

const Entry& entry(Parameter parameter) {
  return *std::find_if(entries.begin(), entries.end(),
                       [&](const Entry& e) { return e.parameter == parameter; });
}

bool has(const Surface& s, Parameter parameter) {
  switch (parameter) {
    case Parameter::tension:
      return s.tension_Pa > 0;
    case Parameter::thickness:
    case Parameter::modulus:
      return bending_modelled(s);
    case Parameter::slope:
      return std::holds_alternative<LinearTaper>(s.taper);
    case Parameter::decay_length:
      return std::holds_alternative<ExponentialTaper>(s.taper);
    case Parameter::clamp_line:
      return !std::holds_alternative<ExponentialTaper>(s.taper);
    case Parameter::temperature:
      return s.expansion_per_K != 0 || s.modulus_per_K != 0;
    default:
      return true;
  }
}

// Returns the value of one of the four parameters on which the cut-off depends.
double value(const Surface& s, Parameter parameter) {
  switch (parameter) {
    case Parameter::density:
      return s.density_kg_m3;
    case Parameter::tension:
      return s.tension_Pa;
    case Parameter::thickness:
      return s.thickness_m;
    default:
      return s.modulus_Pa.value();
  }
}

double cut_off_derivative_m(Surface s, Parameter parameter, double f) {
  // Decide once whether bending is modelled. Otherwise the decision could change with the parameter's value,
  // and the derivative would contain a jump.
  if (s.tension_Pa > 0) s.bending = bending_modelled(s) ? Bending::on : Bending::off;
  const double step = 1e-3 * value(s, parameter);
  return (cut_off_half_width_m(changed(s, parameter, step), f) -
          cut_off_half_width_m(changed(s, parameter, -step), f)) /
         (2 * step);
}

void widen(TaperForm& form, double by) {
  if (auto* linear = std::get_if<LinearTaper>(&form)) linear->half_width_m += by;
  if (auto* exponential = std::get_if<ExponentialTaper>(&form)) exponential->half_width_m += by;
  if (auto* table = std::get_if<TabulatedTaper>(&form)) {
    for (TaperPoint& point : table->points) point.half_width_m += by;
  }
}

void scale(TaperForm& form, double by) {
  if (auto* linear = std::get_if<LinearTaper>(&form)) linear->half_width_m *= by;
  if (auto* exponential = std::get_if<ExponentialTaper>(&form)) {
    exponential->half_width_m *= by;
    exponential->decay_length_m *= by;
  }
  if (auto* table = std::get_if<TabulatedTaper>(&form)) {
    for (TaperPoint& point : table->points) point = {point.x_m * by, point.half_width_m * by};
  }
}

void warm(Surface& s, double by_K) {
  const double stretch = 1 + s.expansion_per_K * by_K;
  s.density_kg_m3 /= stretch * stretch * stretch;
  s.thickness_m *= stretch;
  s.length_m *= stretch;
  scale(s.taper, stretch);
  if (s.modulus_Pa) *s.modulus_Pa *= 1 + s.modulus_per_K * by_K;
}

}  // namespace

std::string_view name(Parameter parameter) { return entry(parameter).name; }
ParameterUnit unit(Parameter parameter) { return entry(parameter).unit; }

double standard_deviation(const Surface& surface, Parameter parameter) {
  return surface.sd.*entry(parameter).sd;
}

void set_standard_deviation(Surface& surface, Parameter parameter, double sd) {
  surface.sd.*entry(parameter).sd = sd;
}

std::optional<Parameter> find_parameter(std::string_view wanted) {
  for (const Entry& e : entries) {
    if (e.name == wanted) return e.parameter;
  }
  return std::nullopt;
}

std::vector<Parameter> parameters(const Surface& surface) {
  std::vector<Parameter> list;
  for (const Entry& e : entries) {
    if (has(surface, e.parameter)) list.push_back(e.parameter);
  }
  return list;
}

Surface changed(Surface s, Parameter parameter, double by) {
  require(std::abs(by) <= largest_size, "change of a parameter", by, "-1e18 to 1e18");
  switch (parameter) {
    case Parameter::density:
      s.density_kg_m3 += by;
      break;
    case Parameter::tension:
      s.tension_Pa += by;
      break;
    case Parameter::thickness:
      s.thickness_m += by;
      break;
    case Parameter::modulus:
      s.modulus_Pa = s.modulus_Pa.value() + by;
      break;
    case Parameter::slope:
      std::get<LinearTaper>(s.taper).slope += by;
      break;
    case Parameter::decay_length:
      std::get<ExponentialTaper>(s.taper).decay_length_m += by;
      break;
    case Parameter::temperature:
      warm(s, by);
      break;
    case Parameter::half_width:
    case Parameter::clamp_line:
      widen(s.taper, by);
      break;
  }
  if (const auto* linear = std::get_if<LinearTaper>(&s.taper); linear != nullptr && linear->slope > 0) {
    s.length_m = std::min(s.length_m, linear->half_width_m / linear->slope);
  }
  return s;
}

// Returns the derivative of a boundary's position with respect to a parameter. The boundary lies where the
// half-width W(x) is `ratio` times the cut-off half-width Wc(f). The excess ratio - 1 is proportional to the
// taper's local slope to the power 2/3, because the boundary's distance from the turning point is
// proportional to the slope to the power -1/3.
double boundary_derivative(const Surface& s, Parameter parameter, double f, double x) {
  validate(s, f);
  require_on_surface(s, "boundary_m", x);
  require_fall(s);
  const Taper taper(s);
  const double w = taper.half_width_m(x), slope = taper.slope(x), cut_off_m = cut_off_half_width_m(s, f);
  const double ratio = w / cut_off_m, by_ln_slope = 2.0 / 3 * (ratio - 1) * cut_off_m;
  const double aside = std::min({1e-3 * s.length_m, x, s.length_m - x});
  const double bend = aside > 0 ? (taper.slope(x + aside) - taper.slope(x - aside)) / (2 * aside) : 0;
  const double fall = by_ln_slope * bend / slope - slope;
  // Derivative, with respect to a parameter, of W(x) - ratio Wc(f), which is 0 at the boundary.
  const auto grows = [&](Parameter p) {
    switch (p) {
      case Parameter::half_width:
        if (const auto* exponential = std::get_if<ExponentialTaper>(&s.taper))
          return (w - by_ln_slope) / exponential->half_width_m;
        return 1.0;
      case Parameter::clamp_line:
        return 1.0;
      case Parameter::slope:
        return -x - by_ln_slope / std::get<LinearTaper>(s.taper).slope;
      case Parameter::decay_length: {
        const double l = std::get<ExponentialTaper>(s.taper).decay_length_m;
        return w * x / (l * l) - by_ln_slope * (x / l - 1) / l;
      }
      default:
        return -ratio * cut_off_derivative_m(s, p, f);
    }
  };
  if (parameter != Parameter::temperature) return grows(parameter) / fall;
  // warming stretches the surface in width and in length
  double rate = s.expansion_per_K * (w + fall * x);
  rate -= 3 * s.expansion_per_K * s.density_kg_m3 * grows(Parameter::density);
  if (bending_modelled(s)) {
    rate += s.expansion_per_K * s.thickness_m * grows(Parameter::thickness);
    rate += s.modulus_per_K * s.modulus_Pa.value() * grows(Parameter::modulus);
  }
  return rate / fall;
}

BoundaryBudget boundary_budget(const Surface& surface, double f, double x) {
  validate(surface, f);
  require_on_surface(surface, "boundary_m", x);
  BoundaryBudget budget;
  if (!(Taper(surface).slope(x) < 0)) return budget;
  auto& parts = budget.contributions;
  for (const Parameter parameter : parameters(surface)) {
    const double sd = standard_deviation(surface, parameter);
    if (sd > 0) parts.push_back({parameter, sd, sd * boundary_derivative(surface, parameter, f, x), 0});
  }
  // Returns how far the boundary moves if one parameter changes and all parameters that are correlated with
  // it change accordingly.
  const auto together_m = [&](const Contribution& part) {
    double sum = part.moved_m;
    for (const Correlation& c : surface.correlations) {
      if (c.first != part.parameter && c.second != part.parameter) continue;
      const Parameter other = c.first == part.parameter ? c.second : c.first;
      for (const Contribution& o : parts) {
        if (o.parameter == other) sum += c.coefficient * o.moved_m;
      }
    }
    return sum;
  };
  double variance = 0;
  for (const Contribution& part : parts) variance += part.moved_m * together_m(part);
  for (Contribution& part : parts)
    part.left_m = std::sqrt(std::max(0.0, variance - std::pow(together_m(part), 2)));
  budget.total_m = std::sqrt(std::max(0.0, variance));
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Contribution& a, const Contribution& b) { return a.left_m < b.left_m; });
  return budget;
}

}  // namespace turnpoint::physics
