#pragma once
#include <optional>
#include <span>

namespace turnpoint::sensing {

/// Forces are measured correctly up to this fraction of the lowest resonance of the plate on its cells: there
/// a cell reads 12 % too much.
inline constexpr double kUsableShare = 1.0 / 3;

/// Returns the frequency with which a force signal rings after a short tap on the plate; empty if nothing was
/// tapped, or if nothing rings between 10 Hz and 0.4 of the rate. `rate_Hz` is the number of points per
/// second. Correct to 3 % for a damping ratio of up to 0.1.
std::optional<double> ringing_Hz(std::span<const double> signal, double rate_Hz);

}  // namespace turnpoint::sensing
