#pragma once
// Computes how uncertain the position of a boundary and the level of a vibration are, and how much each
// uncertain parameter of the surface contributes.
#include <optional>
#include <string_view>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// Convert a parameter to its name, such as "modulus" or "clamp line", and back. find_parameter() returns
// empty if no parameter has this name.
std::string_view name(Parameter parameter);
std::optional<Parameter> find_parameter(std::string_view name);

// The unit in which people state the parameter, and the value of this unit in SI units. A slope has no unit.
struct ParameterUnit {
  std::string_view name;
  double size;
};
ParameterUnit unit(Parameter parameter);

// Read and set the standard deviation of a parameter, which is stored in `surface.sd`, in SI units.
double standard_deviation(const Surface& surface, Parameter parameter);
void set_standard_deviation(Surface& surface, Parameter parameter, double sd);

// The parameters that apply to this surface: for example, a membrane has tension but no modulus, and a linear
// taper has a slope.
std::vector<Parameter> parameters(const Surface& surface);

// Returns the surface with one of its parameters changed by this amount. Moving the clamp line outward adds
// the same length to the half-width everywhere; an exponential taper then becomes a table. A rise in
// temperature stretches every length of the surface and makes it softer, but does not change the tension.
Surface changed(Surface surface, Parameter parameter, double by);

// The derivative of a boundary's position with respect to a parameter (m per SI unit) at constant frequency.
// `boundary_m` is the boundary's position at that frequency. For every definition of the boundary, taper and
// plate theory, the result agrees with solving again on changed surfaces to 1 % of the largest derivative. It
// is 0 for the quality factor. Takes microseconds.
double boundary_derivative(const Surface& surface, Parameter parameter, double frequency_Hz,
                           double boundary_m);

// The part of a boundary's uncertainty that one parameter contributes.
struct Contribution {
  Parameter parameter;
  double sd = 0;  // standard deviation of the parameter, SI units
  // how far the boundary moves if the parameter rises by one standard deviation, positive outward
  double moved_m = 0;
  double left_m = 0;  // the boundary's standard deviation if this parameter were known exactly
};

struct BoundaryBudget {
  std::vector<Contribution> contributions;  // the parameter whose measurement would help most comes first
  double total_m = 0;                       // standard deviation of the boundary's position
};

// Returns the contributions of all parameters that have a standard deviation. If the errors of these
// parameters are correlated, as after a fit of measured boundaries, the total may be less than the root of
// the summed squares.
BoundaryBudget boundary_budget(const Surface& surface, double frequency_Hz, double boundary_m);

struct LevelBudget {
  struct Part {
    Parameter parameter;
    double sd = 0;        // standard deviation of the parameter, SI units
    double level_dB = 0;  // standard deviation of the level if only this parameter is uncertain
  };
  std::vector<Part> parts;  // the parameter with the largest effect comes first
  double total_dB = 0;      // standard deviation of the level
  // 95 % interval of the level, relative to the level that is computed for the surface as it is given
  double low_dB = 0, high_dB = 0;
};

// What the uncertain parameters do to the level at a position, such as that of a finger: the displacement
// there, divided by that of the drive edge. They shift the standing wave against the drive edge, through many
// decibels between a resonance and the next minimum, so that a derivative says nothing. The model `mode` is
// solved on 64 surfaces whose parameters are drawn together, with their correlations, by Latin hypercube
// sampling (McKay, Beckman, Conover 1979) with a fixed seed, and five times for each parameter alone. A thick
// plate with h/W to 0.35 at its turning point is replaced by the thin plate with the same wavenumber, turning
// points and loss; what this finds to be below 1 dB, total or part, is solved on the thick plate itself.
// Densities, moduli, thicknesses, tensions and quality factors are log-normal. Throws std::invalid_argument
// if a standard deviation is so large that a drawn surface cannot exist.
LevelBudget level_budget(const Surface& surface, double frequency_Hz, double at_m);

// The same without the parts.
LevelBudget level_uncertainty(const Surface& surface, double frequency_Hz, double at_m);

}  // namespace turnpoint::physics
