#pragma once
// Computes the finite-element matrices of the two-dimensional field, in the coordinates x and eta = y / W(x).
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "physics/condensed.hpp"
#include "physics/element_basis.hpp"
#include "physics/taper.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {

// The three coefficients in the weak form: bending (lap v lap w), tension (grad v grad w) and inertia (-v w),
// with w the test function.
struct ModalEquation {
  double bending = 0;
  double tension = 1;
  std::complex<double> inertia;
  bool plate() const { return bending > 0; }
};

// One finite element: an interval of x. `left` and `right` are the numbers of transverse functions at its
// ends. At an end that is held, the number is 0.
struct ModalElement {
  double x0 = 0, h = 0;
  int left = 0, right = 0;
  double ln_scale = 0;
  // On a plate, the matrix that gives all other unknowns from those of the left vertex; empty on a membrane.
  Eigen::MatrixXcd transfer;
  Condensed inner;        // matrices that compute the inner unknowns (bubbles) from those of both ends
  Eigen::MatrixXcd pull;  // the unknowns of the right vertex are -pull times those of the left one
  Eigen::VectorXcd load;  // load on all unknowns; empty if there is none
  Eigen::VectorXcd bubbles_under_load, right_under_load;  // what the load adds to the unknowns
  Eigen::VectorXcd centre;                                // value of each basis function on the centre line
};

// Divides the unknowns by the largest magnitude among them and returns the logarithm of this magnitude.
// Fields of any size thus stay in the range of a double. Leaves a vector of zeros unchanged and returns 0.
double take_out_size(Eigen::VectorXcd& unknowns);

class ModalAssembler {
 public:
  ModalAssembler(const Taper& taper, const TransverseBasis& across, const ElementBasis& along,
                 const ModalEquation& equation, double slope_unit_m);
  // The symmetric matrix of an element. Its unknowns are ordered by basis function along x, then by
  // transverse function.
  Eigen::MatrixXcd matrix(const ModalElement& element) const;
  // The unknown for the slope at a vertex is dv/dx times slope_unit. This function returns the factor that
  // converts it to a slope with respect to t.
  double slope_factor(const ModalElement& element) const { return 0.5 * element.h / slope_unit_m_; }

 private:
  struct Point {
    double weight, w, w1, w2;  // weight in the integral over x; half-width, its first and second derivative
    BasisValues basis;         // derivatives with respect to x, in units of the slope unknowns
  };
  std::vector<Point> points(const ModalElement& element) const;
  // Coefficients, at one point, of a symmetric quadratic form in X'', X' and X (letters s, f and v), where
  // X(x) is the function along the strip.
  struct Form {
    double ss, sf, sv, ff, fv, vv;
  };
  Form single_form(double w, double slope_per_width, double curve_per_width) const;
  Eigen::MatrixXcd single_matrix(const ModalElement& element) const;

  const Taper& taper_;
  const TransverseBasis& across_;
  const ElementBasis& along_;
  ModalEquation equation_;
  double slope_unit_m_;
  Quadrature rule_;
  std::vector<BasisValues> table_;
  Eigen::Matrix4d single_bend_;  // across_.bend for the first transverse function only
};

}  // namespace turnpoint::physics
