#pragma once
// Closed formulas for the part of the field that jumps at the corners of a piston-like drive edge.
#include "physics/taper.hpp"

namespace turnpoint::physics {

// A piston moves the whole drive edge by 1 while the sides are held, so the displacement jumps at the two
// corners. Polynomials in y/W converge slowly to a jump: with three spare functions, the field near the drive
// edge is wrong by 1 to 2 %. Let phi be the angle at a corner between the drive edge and the line to (x, y).
// It is harmonic. The sum of both corners' angles, subtracted from its own value on the side and divided by
// the angle of the corner, is 1 on the drive edge and 0 on the sides, and its Laplacian is a smooth function
// of x alone. A cut-off in x takes it to zero at `end_m`. What remains of the field has no jump.
class PistonLift {
 public:
  PistonLift(const Taper& taper, double end_m);

  double end_m() const { return end_m_; }
  double value(double x_m, double y_m) const;
  // Laplacian, without the point masses of the jump
  double laplacian(double x_m, double y_m) const;
  double centre_slope(double x_m) const;  // derivative of the value with respect to x, at y = 0

 private:
  struct Point {
    double value, along, laplacian;  // all without the cut-off in x; `along` is the derivative d/dx
  };
  Point without_cut_off(double x_m, double y_m) const;

  const Taper taper_;
  double w0_, corner_rad_, end_m_;
};

}  // namespace turnpoint::physics
