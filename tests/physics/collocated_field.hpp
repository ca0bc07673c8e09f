#pragma once
// The two-dimensional field of a membrane, a thin plate or Mindlin's plate, by a method that shares nothing
// with `modes` but the closed form of a piston's jump: Chebyshev collocation of the strong form.
#include <complex>
#include <optional>
#include <vector>

#include "physics/piston_lift.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics_test {

struct CollocatedEquations;

struct CollocationGrid {
  int along = 12;  // degree of the polynomials along x in each element
  // number of points between the centre line and the side; half of the phase (rad) between them at the drive
  // edge is added
  int across = 9;
  int across_plate = 9;    // the same for a clamped plate
  double radians = 4;      // phase along x that an element spans at most
  double narrowing = 0.6;  // smallest ratio of the half-widths at an element's right and left end
  // length (in half-widths of the drive edge) over which the closed form of a piston's jump is used
  double lift = 0.8;
  double decay = 26;  // the strip ends where the field has decayed by e^-26 beyond the turning point
};

// The field on the centre line, with v(0) = 1 (exactly, for both shapes of the drive edge).
class CollocatedField {
 public:
  CollocatedField(const physics::Surface& surface, double frequency_Hz, const CollocationGrid& grid = {});
  // displacement on the centre line at x; 0 beyond the end of the strip
  std::complex<double> value(double x_m) const;

 private:
  struct Element {
    double x0, h;
    // displacement on the centre line at the Chebyshev points, from left to right
    std::vector<std::complex<double>> centre;
  };
  template <class Scalar>
  void solve(const physics::Surface& surface, const CollocatedEquations& equations, Scalar inertia, double k,
             const CollocationGrid& grid);
  std::vector<Element> elements_;
  std::optional<physics::PistonLift> lift_;
};

}  // namespace turnpoint::physics_test
