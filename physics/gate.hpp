#pragma once
// The one gate for numbers that no surface can mean. Every public function checks its arguments here, so that
// the solvers see only numbers with which they end soon and whose results are finite.
#include <span>

#include "physics/edge.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// Throws std::invalid_argument, "<quantity> is <value>; allowed: <allowed>", unless `holds`.
void require(bool holds, const char* quantity, double value, const char* allowed);

// The smallest and the largest size (in SI units) of any quantity that has to be above 0. Sixth powers of it
// stay in the range of a double.
inline constexpr double least_size = 1e-18, largest_size = 1e18;
// Throws std::invalid_argument unless the value is a size.
void require_size(const char* quantity, double value);
// Throws std::invalid_argument unless the value is 0 or a size.
void require_size_or_0(const char* quantity, double value);

// The phase (wavenumber times length, in radians) along a surface. With more, a solution would take seconds
// and gigabytes; with less, the surface moves as a whole.
inline constexpr double least_phase_rad = 1e-3, largest_phase_rad = 2e4;
// The largest phase across half of the drive edge: a hundred transverse modes.
inline constexpr double largest_phase_across_rad = 300;
// The largest phase through a thick plate. At shorter wavelengths shear alone carries a wave, which the
// theories leave out.
inline constexpr double largest_phase_through_rad = 2;
// The largest number of points of a tabulated taper, and the smallest distance of two points as a fraction of
// the length.
inline constexpr std::size_t most_taper_points = 2000;
inline constexpr double least_taper_step = 1e-7;
// The largest number of half-widths that follow one another along a surface. (Towards the apex of a linear
// taper there are infinitely many, but only the logarithm of their number counts there.)
inline constexpr double most_half_widths = 2e4;

// Throws std::invalid_argument unless the frequency is a size, and the phase along the surface is within the
// limits above. Validates the surface first.
void validate(const Surface& surface, double frequency_Hz);
// The same for every tone. Also checks the amplitudes and phases, of which at least one must be above 0.
void validate(const Surface& surface, std::span<const Tone> tones);
// The highest frequency that validate() allows on this surface.
double highest_frequency_Hz(const Surface& surface);
// Throws std::invalid_argument for a level outside 0 to 1 of an edge that has one.
void validate(const Edge& edge);
// Throws Refused for a strip of constant width.
void require_fall(const Surface& surface);
// Throws std::invalid_argument unless x is on the surface.
void require_on_surface(const Surface& surface, const char* quantity, double x_m);

}  // namespace turnpoint::physics
