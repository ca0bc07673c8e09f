#pragma once
// Prepares a solution by finite elements: taper, equation, basis functions and the elements themselves.
#include <functional>
#include <vector>

#include "physics/modal_elements.hpp"
#include "physics/modal_field.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

struct ModalSetup {
  Taper taper;
  double k;
  TransverseBasis across;
  ElementBasis along;
  ModalEquation equation;
  double turning_m;  // position of the turning point, or the length if there is none
  int spare;         // number of transverse functions beyond those that follow waves across the strip
};

// Throws std::domain_error if the two-dimensional field is too large to be solved on these sides: too many
// functions across the strip, or too much work.
void require_solvable(const Surface& smooth, double frequency_Hz, const ModalResolution& resolution);

ModalSetup make_modal_setup(const Surface& surface, double frequency_Hz, Losses losses,
                            const ModalResolution& resolution);

// Returns the displacement of the drive edge as a function of eta. Its shape is that of a piston, or of the
// first transverse mode at its cut-off.
std::function<double(double)> drive_shape(const Surface& surface, const ModalEquation& equation);

// Returns the unknowns of the first vertex, which has `functions` transverse functions, for a motion of the
// drive edge with the coefficients `shape`. On a clamped plate, the drive edge has no slope: dv/dx = 0 at
// constant y. The unknowns are derivatives at constant eta = y/W(x), so the slope unknowns are not 0 but W'/W
// eta dv/deta.
Eigen::VectorXd drive_unknowns(const ModalSetup& setup, const TransverseBasis& across,
                               const Eigen::VectorXd& shape, int functions);

// Divides the surface from the drive edge to the far end into elements. They are finer near the corners of
// the drive edge, and elements end at the knots of a tabulated taper. Sets match_m to the position beyond
// which the one-mode equation gives the further decay.
std::vector<ModalElement> make_modal_elements(const ModalSetup& setup, const ModalResolution& resolution,
                                              double& match_m);

}  // namespace turnpoint::physics
