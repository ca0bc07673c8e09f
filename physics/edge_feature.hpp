#pragma once
// Finds the position of one edge (the boundary of a smooth zone) at one frequency by solving for the wave.
#include <optional>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// Which equation for the first transverse mode is solved.
enum class Wave {
  // on a linear taper the two-dimensional mode of the wedge, J_nu(k r) with nu = pi / (2 atan d); on other
  // tapers the equation of the model `mode`
  exact,
  as_modelled  // the chosen model's own equation
};

// The edge's position for a frequency, with loss. Empty if the edge does not exist on the surface. Throws
// std::domain_error if the model does not apply to this surface and frequency. `model` is used only with
// Wave::as_modelled.
std::optional<double> solve_edge_m(const Surface& surface, const MapOptions& options, double frequency_Hz,
                                   Model model, Wave wave);

// The edge's position on a solved centre line; empty if it does not exist on the surface.
std::optional<double> edge_position_m(const Surface& surface, double frequency_Hz, const CentreLine& line,
                                      const MapOptions& options);

// Outermost point at which friction, averaged over the fingertip, crosses `level`. The centre line is scaled
// to context.displacement_m at its last maximum.
std::optional<double> friction_edge_m(double length_m, const CentreLine& line, const FrictionContext& context,
                                      double level);

}  // namespace turnpoint::physics
