#pragma once
// The equations of membranes and plates at points across the strip, for CollocatedField. The unit of length
// is 1/k, where k is the wavenumber of a free wave.
#include <Eigen/Core>
#include <complex>
#include <functional>

#include "physics/piston_lift.hpp"
#include "physics/surface.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics_test {

// Linear equations for the unknowns u at each x, which are the values of one or more fields at the points
// across the strip:
//   second u'' + first(x) u' + (here(x) + inertia mass) u = -(source(x) + inertia mass lift(x)).
struct CollocatedEquations {
  Eigen::VectorXd second;
  std::function<void(double x_m, Eigen::MatrixXd& first, Eigen::MatrixXd& here)> at;
  Eigen::MatrixXd mass;
  std::complex<double> inertia;
  // computes `source` and `lift`, the right-hand side of the equations; empty if both are 0
  std::function<void(double x_m, Eigen::VectorXd& source, Eigen::VectorXd& lift)> load;
  // Conditions at the ends. The first `drive.size()` unknowns are given at both ends: `drive` at the drive
  // edge, 0 at the far end. If there are more unknowns, the other conditions give the derivatives of the
  // first ones with respect to x.
  Eigen::VectorXd drive, drive_slope;
  Eigen::RowVectorXd centre;  // gives the displacement on the centre line from the unknowns
};

// Chebyshev points from -1 to 1, and the matrix that differentiates values at them (Trefethen, Spectral
// Methods in MATLAB, program cheb).
Eigen::VectorXd chebyshev_points(int n);
Eigen::MatrixXd differentiation(const Eigen::VectorXd& points);

// Returns the wavenumber k of a free wave, from D k^4 + N k^2 = rho h omega^2 (D: bending stiffness, N:
// tension per width, rho: density, h: thickness) or from Mindlin's equations.
double free_wavenumber_per_m(const physics::Surface& surface, double frequency_Hz);

// `across` is the number of points from the centre line to the side; half of the phase (rad) between them at
// the drive edge is added. The plate theory may be kirchhoff or mindlin. `lift` is the jump of a membrane's
// piston; plates have none.
CollocatedEquations equations_of(const physics::Surface& surface, double frequency_Hz, int across,
                                 const physics::PistonLift* lift);

}  // namespace turnpoint::physics_test
