#pragma once
// The preparation of a solution by elements: taper, equation, basis and the elements themselves.
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
  int spare;         // number of transverse functions beyond those that can propagate
};

ModalSetup make_modal_setup(const Surface& surface, double frequency_Hz, Losses losses,
                            const ModalResolution& resolution);

// Divides the surface from the drive edge to the end into elements, finer at the drive edge's corners, with
// ends on the taper's knots. match_m is where the one-mode decay is used from then on.
std::vector<ModalElement> make_modal_elements(const ModalSetup& setup, const ModalResolution& resolution,
                                              double& match_m);

}  // namespace turnpoint::physics
