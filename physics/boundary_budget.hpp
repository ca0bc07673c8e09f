#pragma once
// How far what is not known exactly about a surface moves a boundary, parameter by parameter.
#include <optional>
#include <string_view>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// "modulus", "clamp line", ...; empty if no parameter has this name.
std::string_view name(Parameter parameter);
std::optional<Parameter> find_parameter(std::string_view name);

// The unit in which people state the parameter, and its size in SI units; a slope has none.
struct ParameterUnit {
  std::string_view name;
  double size;
};
ParameterUnit unit(Parameter parameter);

// The standard deviation that the surface states for a parameter, in SI units.
double standard_deviation(const Surface& surface, Parameter parameter);
void set_standard_deviation(Surface& surface, Parameter parameter, double sd);

// The parameters that this surface has: a membrane has tension but no modulus, a linear taper has a slope.
std::vector<Parameter> parameters(const Surface& surface);

// The surface with one of its parameters changed by this much. A clamp line moves outward, so both
// half-widths grow everywhere by the same length; an exponential taper then becomes a table. Warmth stretches
// every length of the surface and softens it, but leaves a tension as it is.
Surface changed(Surface surface, Parameter parameter, double by);

// The derivative of a boundary's position with respect to a parameter (m per SI unit), while the frequency
// stays the same. `boundary_m` is where the edge lies at that frequency. It agrees with solving again on
// changed surfaces to 1 % of the largest for every edge, taper and plate theory. Takes microseconds (elastic:
// 0.1 s).
double boundary_derivative(const Surface& surface, Parameter parameter, double frequency_Hz,
                           double boundary_m);

// What one parameter contributes.
struct Contribution {
  Parameter parameter;
  double sd = 0;       // standard deviation of the parameter, SI units
  double moved_m = 0;  // how far one standard deviation moves the boundary, positive outward
  double left_m = 0;   // the total that would be left if this parameter were known exactly
};

struct BoundaryBudget {
  std::vector<Contribution> contributions;  // the one whose measurement would help most comes first
  double total_m = 0;                       // one standard deviation of the boundary
};

// The contributions of all parameters that have a standard deviation. If these are correlated, as after a fit
// of measured boundaries, the total is less than the parts suggest.
BoundaryBudget boundary_budget(const Surface& surface, double frequency_Hz, double boundary_m);

}  // namespace turnpoint::physics
