#pragma once
#include <optional>
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/scene/scene.hpp"

namespace turnpoint::protocol {

/// Returns a scene of the protocol as numbers for these values of the factors: evaluates its expressions,
/// converts the contrast to friction, and changes the strength by `rove_dB`, which the caller has drawn.
/// Throws std::out_of_range for an unknown scene, std::invalid_argument for a factor without a number, and
/// scene::Unreachable if these factors give what a scene follows impossible values.
scene::Scene resolve(const Protocol& protocol, const std::string& scene, const Factors& factors,
                     double rove_dB);

/// Returns the value from `low` to `high` of a numeric factor at which two scenes present the same; empty if
/// there is none, or if they do not differ by the factor.
std::optional<double> where_equal(const Protocol& protocol, const std::string& one, const std::string& other,
                                  const std::string& factor, double low, double high, Factors factors);

/// Returns the friction below `reference` for which 20 log10((reference - friction) / reference) =
/// contrast_dB.
double friction_at_contrast(double reference, double contrast_dB);

}  // namespace turnpoint::protocol
