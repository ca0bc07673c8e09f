#include "physics/figures.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"

namespace turnpoint::physics {
namespace {

constexpr int points = 1201;

// The paper's rubber membrane: half-width 50 mm at the drive. Read off Figure 8: the 30 Hz turning point lies
// at x = 15 on an axis in centimetres, and the taper is taken as the brass one's. Tension follows: c = 4 f
// W(x0).
Surface rubber() {
  Surface s;
  const double w0 = 0.05, slope = 0.1, x0 = 0.15, f = 30;
  s.density_kg_m3 = 1100;
  s.thickness_m = 1e-3;
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

std::string hertz(double f) {
  char text[32];
  std::snprintf(text, sizeof text, f < 1000 ? "%g Hz" : "%g kHz", f < 1000 ? f : f / 1000);
  return text;
}

void add_tone(Figure& figure, const Surface& surface, double f, std::initializer_list<Model> models) {
  const auto x = linspace_points(surface, points);
  const Tone tone{f, 1, 0};
  for (const Model model : models) {
    const Field field = evaluate(surface, {&tone, 1}, x, model, Normalise::peak);
    Curve curve{hertz(f) + ", " + std::string(name(model)), in_mm(x), {}};
    for (const auto& v : field.tones[0].v) curve.value.push_back(v.real());
    figure.curves.push_back(std::move(curve));
  }
  if (const auto x0 = turning_point_m(surface, f))
    figure.marks.push_back({"turning point " + hertz(f), *x0 * 1e3});
}

void add_sum(Figure& figure, const Surface& surface, double f1, double f2) {
  const auto x = linspace_points(surface, points);
  const Tone tones[] = {{f1, 1, 0}, {f2, 1, 0}};
  const Field field = evaluate(surface, tones, x, Model::mode, Normalise::peak);
  figure.curves.push_back(
      {hertz(f1) + " and " + hertz(f2) + ", root of summed squares, mode", in_mm(x), field.amplitude});
}

Figure figure(const char* id, const char* title, const char* note) {
  return {id, title, "distance from the drive edge (mm)", "displacement (last maximum = 1)", note, {}, {}};
}

}  // namespace

std::vector<Figure> figures() {
  const auto all = {Model::airy, Model::seed, Model::mode};
  const auto two = {Model::seed, Model::mode};
  const char* shapes =
      "Lossless shapes with the last maximum at one; the corrected mode grows towards the boundary by "
      "sqrt(W0/W) against equation 11.";
  Figure f3 = figure("figure-3", "Brass membrane, 19.6 kHz", shapes);
  add_tone(f3, seed_brass(), 19600, all);
  Figure f5 = figure("figure-5", "Brass membrane, 20 and 40 kHz", shapes);
  add_tone(f5, seed_brass(), 20000, two);
  add_tone(f5, seed_brass(), 40000, two);
  Figure f8 = figure(
      "figure-8", "Rubber membrane, 30 and 40 Hz",
      "Tension and taper are not published: fitted so that 30 Hz turns at 150 mm, as read from the figure.");
  add_tone(f8, rubber(), 30, two);
  add_tone(f8, rubber(), 40, two);
  Figure f10 = figure("figure-10", "Brass membrane, 8 and 45 kHz, alone and together", shapes);
  add_tone(f10, seed_brass(), 8000, two);
  add_tone(f10, seed_brass(), 45000, two);
  add_sum(f10, seed_brass(), 8000, 45000);
  return {f3, f5, f8, f10};
}

std::string to_csv(const Figure& figure) {
  std::string text = "x_mm";
  for (const Curve& curve : figure.curves) text += ",\"" + curve.label + "\"";
  text += '\n';
  if (figure.curves.empty()) return text;
  for (std::size_t i = 0; i < figure.curves[0].x_mm.size(); ++i) {
    char cell[40];
    std::snprintf(cell, sizeof cell, "%.6g", figure.curves[0].x_mm[i]);
    text += cell;
    for (const Curve& curve : figure.curves) {
      std::snprintf(cell, sizeof cell, ",%.9g", curve.value[i]);
      text += cell;
    }
    text += '\n';
  }
  return text;
}

}  // namespace turnpoint::physics
