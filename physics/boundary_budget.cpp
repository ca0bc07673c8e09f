#include "physics/boundary_budget.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/gate.hpp"
#include "physics/smooth_sides.hpp"
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
    Entry{Parameter::temperature, "temperature", &ParameterSd::temperature_K, {"K", 1}},
    Entry{Parameter::quality_factor, "quality factor", &ParameterSd::quality_factor, {"", 1}}};

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
    case Parameter::quality_factor:
      return std::isfinite(s.quality_factor);
    default:
      return true;
  }
}

// Returns the value of one of the parameters that multiply others and cannot be negative.
double value(const Surface& s, Parameter parameter) {
  switch (parameter) {
    case Parameter::density:
      return s.density_kg_m3;
    case Parameter::tension:
      return s.tension_Pa;
    case Parameter::thickness:
      return s.thickness_m;
    case Parameter::quality_factor:
      return s.quality_factor;
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
    // where the strip would close, it stays a hundredth as wide
    for (TaperPoint& point : table->points)
      point.half_width_m = std::max(point.half_width_m + by, 0.01 * point.half_width_m);
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
    case Parameter::quality_factor:
      s.quality_factor += by;
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
  if (parameter == Parameter::quality_factor) return 0;
  const Taper taper(smooth_sides(s));
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
  if (!(Taper(smooth_sides(surface)).slope(x) < 0)) return budget;
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

namespace {

constexpr int kDraws = 64;

// Returns the surface with one parameter away from its value by this many standard deviations. What cannot be
// negative is distributed log-normally.
Surface away(const Surface& surface, Parameter parameter, double deviations) {
  const double by = deviations * standard_deviation(surface, parameter);
  switch (parameter) {
    case Parameter::density:
    case Parameter::tension:
    case Parameter::thickness:
    case Parameter::modulus:
    case Parameter::quality_factor:
      return changed(surface, parameter,
                     value(surface, parameter) * std::expm1(by / value(surface, parameter)));
    default:
      return changed(surface, parameter, by);
  }
}

// Whether waves of this frequency on a thick plate are those on some thin plate, see thin_equivalent(): up to
// h/W = 0.35 at the turning point, with sides and a loss for which there is such a plate.
bool has_thin_equivalent(const Surface& surface, double f) {
  const auto* linear = std::get_if<LinearTaper>(&surface.taper);
  return surface.theory != PlateTheory::kirchhoff &&
         surface.thickness_m <= 0.35 * cut_off_half_width_m(surface, f) && surface.quality_factor >= 10 &&
         (linear == nullptr || linear->slope <= 0.5);
}

// The thin plate on which waves of this frequency have the same wavenumber, the same turning points and the
// same loss as on a thick plate. Its model `mode` is much cheaper.
Surface thin_equivalent(const Surface& surface, double f) {
  Surface thin = surface;
  thin.theory = PlateTheory::kirchhoff;
  const double softer = wavenumber_per_m(thin, f) / wavenumber_per_m(surface, f);
  *thin.modulus_Pa *= std::pow(softer, 4);
  const auto cut_off_m = [&](double at_Hz) { return cut_off_half_width_m(surface, at_Hz); };
  const double wider = cut_off_half_width_m(thin, f) / cut_off_m(f);
  // A loss acts on a wave by the derivative of ln k to ln f, which is 1/2 on a thin plate.
  constexpr double aside = 1e-4;
  thin.quality_factor *= aside / std::log(cut_off_m(f * (1 - aside)) / cut_off_m(f * (1 + aside)));
  if (auto* linear = std::get_if<LinearTaper>(&thin.taper))
    linear->half_width_m *= wider, linear->slope *= wider;
  else if (auto* exponential = std::get_if<ExponentialTaper>(&thin.taper))
    exponential->half_width_m *= wider;
  else
    for (TaperPoint& point : std::get<TabulatedTaper>(thin.taper).points) point.half_width_m *= wider;
  return thin;
}

// The level at a position of a surface, in decibels relative to the drive edge.
double level_dB(const Surface& surface, double f, double at_m) {
  const auto line = make_centre_line(surface, f, Model::mode);
  const double ln =
      line->value(std::min(at_m, surface.length_m)).ln_magnitude() - line->value(0).ln_magnitude();
  return 20 / std::numbers::ln10 * std::clamp(ln, -700.0, 700.0);
}

// The middles of kDraws equally probable strata of a normal deviate, by Newton's method.
std::vector<double> strata() {
  std::vector<double> z(kDraws);
  for (int i = 0; i < kDraws; ++i) {
    const double wanted = (i + 0.5) / kDraws;
    double& at = z[static_cast<std::size_t>(i)];
    for (int step = 0; step < 50; ++step)
      at += (wanted - 0.5 * std::erfc(-at / std::numbers::sqrt2)) * std::sqrt(2 * std::numbers::pi) *
            std::exp(std::min(4.0, 0.5 * at * at));
  }
  return z;
}

// Phase of the wave between the drive edge and its turning point (WKB); without a turning point, to the end.
double phase_rad(const Surface& surface, double f) {
  const MarchEquation equation = march_equation(surface, f, Losses::left_out);
  const Taper taper(surface);
  const double end_m = turning_point_m(surface, f).value_or(surface.length_m);
  constexpr int steps = 64;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps, w = taper.half_width_m(end_m * (1 - u * u));
    sum += u * std::sqrt(std::max(0.0, equation.a.real() - equation.b / (w * w)));
  }
  return 2 * end_m * sum / steps;
}

// Shuffles by the generator of Steele, Lea and Flood (2014), so that all computers draw the same surfaces.
void shuffle(std::vector<double>& values, std::uint64_t& state) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::uint64_t z = state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    std::swap(values[i - 1], values[(z ^ (z >> 31)) % i]);
  }
}

// The lower triangle L of the correlations of some parameters, R = L L'.
Eigen::MatrixXd triangle(const Surface& surface, const std::vector<Parameter>& of) {
  const auto n = static_cast<Eigen::Index>(of.size());
  Eigen::MatrixXd l = Eigen::MatrixXd::Identity(n, n);
  const auto at = [&of](Parameter p) { return std::find(of.begin(), of.end(), p) - of.begin(); };
  for (const Correlation& c : surface.correlations)
    if (at(c.first) < n && at(c.second) < n)
      l(at(c.first), at(c.second)) = l(at(c.second), at(c.first)) = c.coefficient;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double left = l(i, j) - l.row(i).head(j).dot(l.row(j).head(j));
      l(i, j) = i == j ? std::sqrt(std::max(0.0, left)) : l(j, j) > 0 ? left / l(j, j) : 0;
    }
  return l.triangularView<Eigen::Lower>();
}

// Deviations of the parameters for kDraws surfaces, a column for each. The phase moves with the first of the
// independent deviates alone, because the reflection of Householder (1958) turns its axis to the gradient.
Eigen::MatrixXd draws(const Surface& surface, double f, const std::vector<Parameter>& of) {
  const auto n = static_cast<Eigen::Index>(of.size());
  Eigen::MatrixXd deviates(n, kDraws);
  std::uint64_t state = 1;
  Eigen::VectorXd gradient(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Parameter p = of[static_cast<std::size_t>(i)];
    gradient(i) = phase_rad(away(surface, p, 0.5), f) - phase_rad(away(surface, p, -0.5), f);
    std::vector<double> values = strata();
    if (i > 0) shuffle(values, state);
    deviates.row(i) = Eigen::Map<Eigen::RowVectorXd>(values.data(), kDraws);
  }
  const Eigen::MatrixXd l = triangle(surface, of);
  Eigen::VectorXd mirror = (l.transpose() * gradient).normalized();
  mirror(0) -= 1;
  if (const double square = mirror.squaredNorm(); square > 0)
    deviates -= mirror * (2 / square * (mirror.transpose() * deviates));
  return l * deviates;
}

// The value below which this share of sorted values lies.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size()) - 0.5;
  const auto below = static_cast<std::size_t>(at);
  return std::lerp(sorted[below], sorted[below + 1], at - static_cast<double>(below));
}

// How levels are found: on the surface itself, or on the thin plate in its place.
using SolveLevel = double (*)(const Surface&, double, double);

double thin_level_dB(const Surface& surface, double f, double at_m) {
  return level_dB(thin_equivalent(surface, f), f, at_m);
}

// Where the thin plate finds less than this, it matters how far each resonance is: the thick plate is solved.
constexpr double little_dB = 1;

// The spread of the levels on the drawn surfaces.
LevelBudget spread(const Surface& surface, double f, double at_m, const std::vector<Surface>& drawn,
                   SolveLevel solve) {
  std::vector<double> levels;
  for (const Surface& one : drawn) levels.push_back(solve(one, f, at_m));
  const double here_dB = solve(surface, f, at_m);
  std::sort(levels.begin(), levels.end());
  LevelBudget budget;
  budget.low_dB = quantile(levels, 0.025) - here_dB;
  budget.high_dB = quantile(levels, 0.975) - here_dB;
  const double mean = std::accumulate(levels.begin(), levels.end(), 0.0) / kDraws;
  double square = 0;
  for (const double level : levels) square += std::pow(level - mean, 2);
  budget.total_dB = std::sqrt(square / kDraws);
  return budget;
}

// A normal deviate away from its mean in both directions, and the probability of each.
struct Deviate {
  double away, weight;
};
// Gauss and Hermite's rules of three and of five points, without the mean.
constexpr std::array three_points{Deviate{1.7320508075688772, 1.0 / 6}};
constexpr std::array five_points{Deviate{1.355626179974266, 0.222075922005613},
                                 Deviate{2.856970013872806, 0.011257411327721}};

// Standard deviation of the level if only this parameter is uncertain; `here_dB` is the surface's own.
double alone_dB(const Surface& surface, double f, double at_m, Parameter parameter, SolveLevel solve,
                double here_dB, std::span<const Deviate> points) {
  double mean = 0, square = 0;
  for (const Deviate& point : points)
    for (const double side : {-1.0, 1.0}) {
      const double moved = solve(away(surface, parameter, side * point.away), f, at_m) - here_dB;
      mean += point.weight * moved, square += point.weight * moved * moved;
    }
  return std::sqrt(std::max(0.0, square - mean * mean));
}

}  // namespace

LevelBudget level_uncertainty(const Surface& surface, double f, double at_m) {
  validate(surface, f);
  require_on_surface(surface, "at_m", at_m);
  std::vector<Parameter> uncertain;
  for (const Parameter parameter : parameters(surface))
    if (standard_deviation(surface, parameter) > 0) uncertain.push_back(parameter);
  if (uncertain.empty()) return {};
  std::vector<Surface> drawn(kDraws, surface);
  const Eigen::MatrixXd deviations = draws(surface, f, uncertain);
  for (Eigen::Index draw = 0; draw < kDraws; ++draw)
    for (std::size_t i = 0; i < uncertain.size(); ++i) {
      Surface& one = drawn[static_cast<std::size_t>(draw)];
      one = away(one, uncertain[i], deviations(static_cast<Eigen::Index>(i), draw));
    }
  if (has_thin_equivalent(surface, f)) {
    const LevelBudget budget = spread(surface, f, at_m, drawn, thin_level_dB);
    if (budget.total_dB > little_dB) return budget;
  }
  return spread(surface, f, at_m, drawn, level_dB);
}

LevelBudget level_budget(const Surface& surface, double f, double at_m) {
  LevelBudget budget = level_uncertainty(surface, f, at_m);
  const bool by_thin = has_thin_equivalent(surface, f) && budget.total_dB > little_dB;
  const double here_dB = level_dB(surface, f, at_m);
  const double thin_here_dB = by_thin ? thin_level_dB(surface, f, at_m) : here_dB;
  for (const Parameter parameter : parameters(surface)) {
    const double sd = standard_deviation(surface, parameter);
    if (!(sd > 0)) continue;
    const auto alone = [&](SolveLevel solve, double own_dB, std::span<const Deviate> points) {
      return alone_dB(surface, f, at_m, parameter, solve, own_dB, points);
    };
    double part_dB = by_thin ? alone(thin_level_dB, thin_here_dB, five_points) : 0;
    if (part_dB <= little_dB) {
      // a part that is small by both rules is nearly linear in the deviate, for which three points are enough
      if (by_thin) part_dB = alone(level_dB, here_dB, three_points);
      if (!by_thin || part_dB > little_dB) part_dB = alone(level_dB, here_dB, five_points);
    }
    budget.parts.push_back({parameter, sd, part_dB});
  }
  std::stable_sort(budget.parts.begin(), budget.parts.end(),
                   [](const auto& a, const auto& b) { return a.level_dB > b.level_dB; });
  return budget;
}

}  // namespace turnpoint::physics
