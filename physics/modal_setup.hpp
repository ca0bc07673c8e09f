#pragma once
// The starting point of a solution by elements: taper, equation, basis and the elements themselves.
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
  double turning_m;  // or the length
  int spare;         // transverse functions beyond those that can propagate
};

ModalSetup make_modal_setup(const Surface& surface, double frequency_Hz, Losses losses,
                            const ModalResolution& resolution);

// Intervals from the drive edge to the end, finer at the drive edge's corners, ending on the taper's knots.
// match_m: where the one-mode decay takes over.
std::vector<ModalElement> make_modal_elements(const ModalSetup& setup, const ModalResolution& resolution,
                                              double& match_m);

}  // namespace turnpoint::physics
