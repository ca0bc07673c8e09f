#include "physics/figures.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"

namespace turnpoint::physics {
namespace {

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

constexpr std::array kModels{Model::mode, Model::seed, Model::airy};
constexpr std::array kLabels{"corrected mode", "paper's eq. 11, exact", "paper's Airy profile, eqs. 20-22"};

FigurePanel tone_panel(const Surface& surface, double f) {
  const auto x = linspace_points(surface, points);
  const Tone tone{f, 1, 0};
  FigurePanel panel{hertz(f), "displacement (last maximum = 1)", {}, {}};
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    const Field field = evaluate(surface, {&tone, 1}, x, kModels[i], Normalise::peak);
    Curve curve{kLabels[i], in_mm(x), {}};
    for (const auto& v : field.tones[0].v) curve.value.push_back(v.real());
    panel.curves.push_back(std::move(curve));
  }
  if (const auto x0 = turning_point_m(surface, f)) panel.marks.push_back({"turning point", *x0 * 1e3});
  return panel;
}

FigurePanel sum_panel(const Surface& surface, double f1, double f2) {
  const auto x = linspace_points(surface, points);
  const Tone tones[] = {{f1, 1, 0}, {f2, 1, 0}};
  FigurePanel panel{
      hertz(f1) + " and " + hertz(f2) + " together", "amplitude (root of summed squares)", {}, {}};
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    const Field field = evaluate(surface, tones, x, kModels[i], Normalise::peak);
    panel.curves.push_back({kLabels[i], in_mm(x), field.amplitude});
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
