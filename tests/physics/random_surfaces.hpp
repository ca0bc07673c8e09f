#pragma once
// Random surfaces of every kind, for a frequency of 20 kHz.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "physics/dispersion.hpp"
#include "physics/surface.hpp"
#include "tests/physics/random_scenes.hpp"

namespace turnpoint::physics_test {

inline constexpr double frequency_Hz = 20000;

// Half-widths of a straight taper, measured with independent errors of this relative size and put in
// descending order, as a table demands. `wide` multiplies them all, and the slope.
inline std::vector<physics::TaperPoint> noisy_points(int count, double error, bool even, double wide) {
  Draw draw(1);
  std::vector<physics::TaperPoint> points;
  std::vector<double> widths;
  for (int i = 0; i < count; ++i) {
    const bool inner = i > 0 && i + 1 < count;
    points.push_back({0.44 * (i + (even || !inner ? 0 : draw.between(-0.4, 0.4))) / (count - 1), 0});
    widths.push_back(wide * (0.0151 - 0.03 * points.back().x_m) *
                     (1 + std::sqrt(3.0) * draw.between(-error, error)));
  }
  points.back().x_m = 0.44;
  std::ranges::sort(widths, std::greater());
  for (std::size_t i = 0; i < widths.size(); ++i) points[i].half_width_m = widths[i];
  return points;
}

inline physics::Surface tabulated(const physics::Surface& like, std::vector<physics::TaperPoint> points) {
  physics::Surface s = like;
  s.taper = physics::TabulatedTaper{std::move(points)};
  return s;
}

// A plate like that of the simulated rig.
inline physics::Surface tapered_plate(physics::PlateTheory theory) {
  physics::Surface s = physics::aluminium_plate();
  s.theory = theory;
  s.length_m = 0.44;
  return s;
}

// Returns a table of 4 to 6 points with long, nearly even parts and steep steps. Higher modes are trapped
// between the steps.
inline physics::TabulatedTaper stepped_table(Draw& draw, double w0, double length) {
  physics::TabulatedTaper table{{{0, w0}}};
  const int points = 4 + static_cast<int>(draw.next() % 3);
  double x = 0, w = w0;
  for (int i = 1; i < points; ++i) {
    x += length / (points - 1) * draw.between(0.6, 1.4);
    const double left = w - 0.05 * w0;
    const double fall = draw.next() % 2 == 0 ? draw.between(0.4, 0.8) : draw.between(0.005, 0.05);
    w -= i == points - 1 ? left : left * fall;
    table.points.push_back({x, w});
  }
  return table;
}

// Sets taper and length: linear, exponential, or a smooth or stepped table. `ratio` is the half-width of the
// drive edge over `cut`, the cut-off half-width.
inline void random_taper(Draw& draw, physics::Surface& s, double cut, double ratio, double slope) {
  const double w0 = ratio * cut, length = w0 / slope;
  switch (draw.next() % 4) {
    case 0:
      s.taper = physics::LinearTaper{w0, slope};
      s.length_m = length * draw.between(0.9, 1);
      break;
    case 1:
      s.taper = physics::ExponentialTaper{w0, cut / slope};
      s.length_m = cut / slope * (std::log(ratio) + 1.8);
      break;
    case 2:
      s.taper = physics::TabulatedTaper{{{0, w0},
                                         {0.3 * length, w0 * draw.between(0.65, 0.8)},
                                         {0.6 * length, w0 * draw.between(0.35, 0.5)},
                                         {0.95 * length, 0.05 * w0}}};
      s.length_m = 0.95 * length;
      break;
    default: {
      const physics::TabulatedTaper table = stepped_table(draw, w0, length);
      s.taper = table;
      s.length_m = table.points.back().x_m;
    }
  }
}

inline double random_quality_factor(Draw& draw) {
  return draw.next() % 3 == 0 ? std::numeric_limits<double>::infinity() : draw.spread(5, 2000);
}

// Returns a membrane with a random taper of any kind and one of the two drive shapes.
inline physics::Surface random_membrane(Draw& draw) {
  physics::Surface s = physics::seed_brass();
  const double cut = physics::cut_off_half_width_m(s, frequency_Hz);
  const double ratio = draw.between(1.15, 10), slope = draw.spread(0.02, 0.5);
  s.quality_factor = random_quality_factor(draw);
  s.drive = draw.next() % 3 == 0 ? physics::DriveShape::piston : physics::DriveShape::cosine;
  random_taper(draw, s, cut, ratio, slope);
  return s;
}

// Returns a plate of 0.3 to 3 mm with any taper, driven with the shape of its first mode. One in four is
// simply supported and has straight sides, one in four clamped under tension, and the others clamped without
// tension.
inline physics::Surface random_thin_plate(Draw& draw) {
  physics::Surface s = physics::aluminium_plate();
  s.thickness_m = draw.spread(0.3e-3, 3e-3);
  const auto kind = draw.next() % 4;
  if (kind == 0) s.edges = physics::Edges::supported;
  const double free_cut = physics::cut_off_half_width_m(s, frequency_Hz);
  // the width of the boundary layer that the tension makes is from 3 times down to 1/15 of the half-width
  if (kind <= 1) {
    const double layers = draw.spread(0.3, 15);
    s.bending = physics::Bending::on;
    s.tension_Pa =
        layers * layers * *physics::bending_stiffness_N_m(s) / (free_cut * free_cut * s.thickness_m);
  }
  s.quality_factor = random_quality_factor(draw);
  const double ratio = draw.between(1.15, 5), slope = draw.spread(0.02, 0.5);
  const double cut = physics::cut_off_half_width_m(s, frequency_Hz);
  random_taper(draw, s, cut, ratio, slope);
  // The reference solves simply supported plates as membranes, which is right for straight sides only.
  if (kind == 0) {
    s.taper = physics::LinearTaper{ratio * cut, slope};
    s.length_m = 0.95 * ratio * cut / slope;
  }
  s.quality_factor /= physics::Dispersion(s).wave_quality(frequency_Hz, 1);
  return s;
}

// Returns a clamped plate with Mindlin's theory, whose thickness is 0.05 to 0.5 of its half-width at the
// cut-off.
inline physics::Surface random_thick_plate(Draw& draw) {
  physics::Surface s = physics::aluminium_plate();
  s.theory = physics::PlateTheory::mindlin;
  s.poisson = draw.between(0.1, 0.45);
  s.thickness_m = draw.spread(0.1e-3, 10e-3);
  s.quality_factor = 0.5 * random_quality_factor(draw);
  const double ratio = draw.between(1.15, 4), slope = draw.spread(0.02, 0.3);
  random_taper(draw, s, physics::cut_off_half_width_m(s, frequency_Hz), ratio, slope);
  return s;
}

}  // namespace turnpoint::physics_test
