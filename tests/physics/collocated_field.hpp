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
  int along = 12;  // degree in each element along x
  // number of points between the centre and the side, in addition to those that half of the phase across
  // needs
  int across = 9;
  int across_plate = 9;    // this number for a clamped plate
  double radians = 4;      // phase along x that an element spans at most
  double narrowing = 0.6;  // smallest ratio of the half-widths at an element's right and left end
  double lift = 0.8;       // how far a piston's jump reaches, in half-widths of the drive edge
  double decay = 26;       // the strip ends where the field has decayed by e^-26 beyond the turning point
};

// The field on the centre line, with v(0) = 1 (exactly, for both shapes of the drive edge).
class CollocatedField {
 public:
  CollocatedField(const physics::Surface& surface, double frequency_Hz, const CollocationGrid& grid = {});
  std::complex<double> value(double x_m) const;  // 0 beyond the end

 private:
  struct Element {
    double x0, h;
    std::vector<std::complex<double>> centre;  // at the Chebyshev points, from left to right
  };
  template <class Scalar>
  void solve(const physics::Surface& surface, const CollocatedEquations& equations, Scalar inertia, double k,
             const CollocationGrid& grid);
  std::vector<Element> elements_;
  std::optional<physics::PistonLift> lift_;
};

}  // namespace turnpoint::physics_test
