#pragma once
// Element matrices of the two-dimensional field in the coordinates (x, eta = y / W(x)).
#include <Eigen/Dense>
#include <complex>
#include <vector>

#include "physics/element_basis.hpp"
#include "physics/taper.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {

// Factors of the weak form: bending lap v lap w + tension grad v grad w - inertia v w
struct ModalEquation {
  double bending = 0;
  double tension = 1;
  std::complex<double> inertia;
  bool plate() const { return bending > 0; }
};

// One interval of x. `left` and `right` are the numbers of transverse functions at its ends; 0 means that the
// end is held.
struct ModalElement {
  double x0 = 0, h = 0;
  int left = 0, right = 0;
  double ln_scale = 0;
  Eigen::MatrixXcd transfer;  // gives the unknowns of bubbles and right vertex from those of the left vertex
  Eigen::VectorXcd centre;    // each basis function's coefficient at the centre line, after solving
};

// Divides by the largest magnitude and returns its logarithm, so that fields of any size stay in range. Leaves
// a zero vector as it is and returns 0.
double take_out_size(Eigen::VectorXcd& unknowns);

class ModalAssembler {
 public:
  ModalAssembler(const Taper& taper, const TransverseBasis& across, const ElementBasis& along,
                 const ModalEquation& equation, double slope_unit_m);
  // The symmetric matrix of an element. Unknowns are ordered by basis function, then by transverse function.
  Eigen::MatrixXcd matrix(const ModalElement& element) const;
  // Factor that converts the unknown of a vertex slope (dv/dx slope_unit) to a slope with respect to t.
  double slope_factor(const ModalElement& element) const { return 0.5 * element.h / slope_unit_m_; }

 private:
  struct Point {
    double weight, w, w1, w2;  // weight in the integral over x; half-width and its two derivatives
    BasisValues basis;         // derivatives with respect to x, in units of the slope unknowns
  };
  std::vector<Point> points(const ModalElement& element) const;
  // A symmetric quadratic form of (X'', X', X) at one point.
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
  Eigen::Matrix4d single_bend_;  // the integrals across_.bend of the first function
};

}  // namespace turnpoint::physics
