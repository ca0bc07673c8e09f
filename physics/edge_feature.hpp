#pragma once
// Finds the position of one edge at one frequency on a solved profile.
#include <optional>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// Which equation for the first transverse mode a boundary map uses.
enum class Wave {
  // the two-dimensional mode of a linear taper (a wedge: J_nu(k r), nu = pi / 2 atan d); on other tapers
  // `mode`
  exact,
  as_modelled  // the chosen model's own equation
};

// The centre line, with or without loss, on which positions are found.
std::unique_ptr<CentreLine> make_feature_line(const Surface& surface, double frequency_Hz, Model model,
                                              Wave wave, Losses losses);

// The edge's position on a solved centre line; empty if it does not exist on the surface.
std::optional<double> edge_position_m(const Surface& surface, double frequency_Hz, const CentreLine& line,
                                      const MapOptions& options);

// Outermost point at which friction, averaged over the fingertip, crosses `level`. The centre line is scaled
// to context.displacement_m at its last maximum.
std::optional<double> friction_edge_m(double length_m, const CentreLine& line, const FrictionContext& context,
                                      double level);

}  // namespace turnpoint::physics
