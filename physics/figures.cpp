#include "physics/figures.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;
constexpr int points = 1201;

// The paper's rubber membrane, which is 50 mm wide on each side of the centre line at the drive edge. In
// Figure 8 its turning point x0 for 30 Hz is at 15 cm. The paper does not give the slope of its taper, so the
// slope of the brass membrane is assumed. The tension then follows from the wave speed c = 4 f W(x0).
Surface rubber() {
  Surface s;
  const double w0 = 0.05, slope = 0.1, x0 = 0.15, f = 30;
  s.density_kg_m3 = 1000;
  s.thickness_m = 0.02e-3;
  s.length_m = w0 / slope;
  s.quality_factor = std::numeric_limits<double>::infinity();
  s.taper = LinearTaper{w0, slope};
  const double c = 4 * f * (w0 - slope * x0);
  s.tension_Pa = s.density_kg_m3 * c * c;
  return s;
}

std::vector<double> in_mm(const std::vector<double>& x) {
  std::vector<double> mm;
  for (const double one : x) mm.push_back(one * 1e3);
  return mm;
}

// As printf's %g does, but in every locale with a decimal point.
std::string rounded(double value, int digits) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}

std::string hertz(double f) { return f < 1000 ? rounded(f, 6) + " Hz" : rounded(f / 1000, 6) + " kHz"; }

constexpr std::array kLabels{"corrected mode", "paper's eq. 11, exact", "paper's Airy profile, eqs. 20-22"};

// Airy's function Ai (DLMF 9.6). The negative order -1/3 is made of orders 1/3 of both kinds.
double airy(double t) {
  const double z = std::abs(t), zeta = 2.0 / 3 * z * std::sqrt(z), order = 1.0 / 3;
  if (z < 1e-9) return 0.35502805388781724;
  if (t > 0) return std::sqrt(z / 3) / pi * std::cyl_bessel_k(order, zeta);
  return 0.5 * std::sqrt(z / 3) *
         (std::sqrt(3) * std::cyl_bessel_j(order, zeta) - std::cyl_neumann(order, zeta));
}

// One of the paper's two profiles on a linear taper that ends at its apex, divided by its last maximum.
class PaperProfile {
 public:
  enum class Kind { equation_11, airy };
  PaperProfile(const Surface& surface, double f, Kind kind) : kind_(kind) {
    const auto& taper = std::get<LinearTaper>(surface.taper);
    apex_m_ = taper.half_width_m / taper.slope;
    k_ = wavenumber_per_m(surface, f);
    const double m = pi / (2 * taper.slope);
    order_ = std::sqrt(m * m + 0.25);
    turning_m_ = turning_point_m(surface, f).value();
    airy_per_m_ = std::cbrt(4 * taper.slope * k_ * k_ * k_ / pi);
    last_maximum_ = find_last_maximum();
  }
  double operator()(double x) const { return value(x) / last_maximum_; }

 private:
  // Equation 11 is solved by sqrt(s) J_mu(k s), s the distance from the apex and mu^2 = (pi/2d)^2 + 1/4.
  double value(double x) const {
    if (kind_ == Kind::airy) return airy(airy_per_m_ * (x - turning_m_));
    const double s = std::max(0.0, apex_m_ - x);
    return std::sqrt(s) * std::cyl_bessel_j(order_, k_ * s);
  }
  // Walks from the apex to the first maximum, then takes the vertex of the parabola through three points.
  double find_last_maximum() const {
    const double step = 1e-4 / airy_per_m_;
    double x = turning_m_ + 2 / airy_per_m_;
    x = std::min(x, apex_m_ - 2 * step);
    while (value(x - step) > value(x)) x -= step;
    const double a = value(x - step), b = value(x), c = value(x + step);
    return b - (a - c) * (a - c) / (8 * (a - 2 * b + c));
  }

  Kind kind_;
  double apex_m_ = 0, k_ = 0, order_ = 0, turning_m_ = 0, airy_per_m_ = 0, last_maximum_ = 1;
};

// The displacement of one tone by the corrected mode, equation 11 and the Airy profile, in this order.
std::array<std::vector<double>, 3> tone_curves(const Surface& surface, double f,
                                               const std::vector<double>& x) {
  const Tone tone{f, 1, 0};
  std::array<std::vector<double>, 3> curves;
  for (const auto& v : evaluate(surface, {&tone, 1}, x, Model::mode, Normalise::peak).tones[0].v)
    curves[0].push_back(v.real());
  const PaperProfile exact(surface, f, PaperProfile::Kind::equation_11),
      near(surface, f, PaperProfile::Kind::airy);
  for (const double one : x) curves[1].push_back(exact(one)), curves[2].push_back(near(one));
  return curves;
}

FigurePanel tone_panel(const Surface& surface, double f) {
  const auto x = linspace_points(surface, points);
  FigurePanel panel{hertz(f), "displacement (last maximum = 1)", {}, {}};
  auto curves = tone_curves(surface, f, x);
  for (std::size_t i = 0; i < curves.size(); ++i)
    panel.curves.push_back({kLabels[i], in_mm(x), std::move(curves[i])});
  if (const auto x0 = turning_point_m(surface, f)) panel.marks.push_back({"turning point", *x0 * 1e3});
  return panel;
}

FigurePanel sum_panel(const Surface& surface, double f1, double f2) {
  const auto x = linspace_points(surface, points);
  FigurePanel panel{
      hertz(f1) + " and " + hertz(f2) + " together", "amplitude (root of summed squares)", {}, {}};
  auto curves = tone_curves(surface, f1, x);
  const auto others = tone_curves(surface, f2, x);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) curves[i][j] = std::hypot(curves[i][j], others[i][j]);
    panel.curves.push_back({kLabels[i], in_mm(x), std::move(curves[i])});
  }
  for (const double f : {f1, f2})
    if (const auto x0 = turning_point_m(surface, f)) panel.marks.push_back({hertz(f), *x0 * 1e3});
  return panel;
}

Figure figure(const char* id, const char* title, const std::string& note) {
  return {id, title, "distance from the drive edge (mm)", note, {}};
}

}  // namespace

std::vector<Figure> figures() {
  const std::string shapes =
      "Shapes without loss. The corrected mode conserves the energy flux: compared with eq. 11, it grows by "
      "sqrt(W0/W) towards the boundary.";
  Figure f3 = figure("figure-3", "Brass membrane, 19.6 kHz", shapes);
  f3.panels = {tone_panel(seed_brass(), 19600)};
  Figure f5 = figure("figure-5", "Brass membrane, 20 and 40 kHz", shapes);
  f5.panels = {tone_panel(seed_brass(), 20000), tone_panel(seed_brass(), 40000)};
  Figure f8 = figure("figure-8", "Rubber membrane, 30 and 40 Hz",
                     "Tension and taper of the rubber are not published, and its tension would have to move "
                     "2.7 times its mass of air "
                     "as well. They are fitted so that the turning point "
                     "for 30 Hz is at 150 mm, as in the paper. " +
                         shapes);
  f8.panels = {tone_panel(rubber(), 30), tone_panel(rubber(), 40)};
  Figure f10 = figure("figure-10", "Brass membrane, 8 and 45 kHz, alone and together", shapes);
  f10.panels = {tone_panel(seed_brass(), 8000), tone_panel(seed_brass(), 45000),
                sum_panel(seed_brass(), 8000, 45000)};
  return {f3, f5, f8, f10};
}

std::string to_csv(const Figure& figure) {
  std::vector<const Curve*> curves;
  std::string text = "x_mm";
  for (const FigurePanel& panel : figure.panels) {
    for (const Curve& curve : panel.curves) {
      text += ",\"" + panel.title + ": " + curve.label + "\"";
      curves.push_back(&curve);
    }
  }
  text += '\n';
  if (curves.empty()) return text;
  for (std::size_t i = 0; i < curves[0]->x_mm.size(); ++i) {
    text += rounded(curves[0]->x_mm[i], 6);
    for (const Curve* curve : curves) text += "," + rounded(curve->value[i], 9);
    text += '\n';
  }
  return text;
}

}  // namespace turnpoint::physics
