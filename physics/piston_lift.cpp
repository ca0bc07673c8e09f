#include "physics/piston_lift.hpp"

#include <cmath>
#include <numbers>

namespace turnpoint::physics {
namespace {

// A function of x and its first two derivatives.
struct Jet {
  double value, first, second;
};

// Returns atan2(x, b(x)). This is the angle at a corner of a point whose distance from the corner is x along
// the strip and b(x) across.
Jet angle(double x, const Jet& b) {
  const double square = x * x + b.value * b.value;
  const double turn = b.value - x * b.first;
  return {std::atan2(x, b.value), turn / square,
          (-x * b.second - turn * (2 * x + 2 * b.value * b.first) / square) / square};
}

// Returns a smooth step from 1 at t = 0 (the drive edge) to 0 at t = 1 and beyond. Its first two derivatives
// are continuous and vanish at both ends.
Jet cut_off(double t) {
  if (t >= 1) return {0, 0, 0};
  const double t2 = t * t, u = 1 - t;
  return {1 - t2 * t * (10 - 15 * t + 6 * t2), -30 * t2 * u * u, -60 * t * u * (1 - 2 * t)};
}

}  // namespace

PistonLift::PistonLift(const Taper& taper, double end_m)
    : taper_(taper),
      w0_(taper.half_width_m(0)),
      corner_rad_(std::numbers::pi / 2 - std::atan(-taper.slope(0))),
      end_m_(end_m) {}

PistonLift::Point PistonLift::without_cut_off(double x, double y) const {
  if (!(x > 0)) return {1, 0, 0};
  const double w = taper_.half_width_m(x), slope = taper_.slope(x), curve = taper_.second_derivative(x);
  const Jet near = angle(x, {w0_ - w, -slope, -curve}), far = angle(x, {w0_ + w, slope, curve});
  const Jet up = angle(x, {w0_ - y, 0, 0}), down = angle(x, {w0_ + y, 0, 0});
  return {(near.value + far.value - up.value - down.value) / corner_rad_,
          (near.first + far.first - up.first - down.first) / corner_rad_,
          (near.second + far.second) / corner_rad_};
}

double PistonLift::value(double x, double y) const {
  if (x >= end_m_) return 0;
  return cut_off(x / end_m_).value * without_cut_off(x, y).value;
}

double PistonLift::laplacian(double x, double y) const {
  if (x >= end_m_) return 0;
  const Jet c = cut_off(x / end_m_);
  const Point p = without_cut_off(x, y);
  return c.value * p.laplacian + (2 * c.first * p.along + c.second / end_m_ * p.value) / end_m_;
}

double PistonLift::centre_slope(double x) const {
  if (x >= end_m_) return 0;
  const Jet c = cut_off(x / end_m_);
  const Point p = without_cut_off(x, 0);
  return c.value * p.along + c.first / end_m_ * p.value;
}

}  // namespace turnpoint::physics
