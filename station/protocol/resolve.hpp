#pragma once
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/scene/scene.hpp"

namespace turnpoint::protocol {

/// A scene of the protocol as numbers for these factors: evaluates the arithmetic, converts the contrast to
/// friction and applies `rove_dB` (already drawn, within the scene's limits). Throws std::out_of_range for an
/// unknown scene and std::invalid_argument for a factor without a number.
scene::Scene resolve(const Protocol& protocol, const std::string& scene, const Factors& factors,
                     double rove_dB);

/// The friction that is lower than `reference` by a contrast of 20 log10(difference / reference).
double friction_at_contrast(double reference, double contrast_dB);

}  // namespace turnpoint::protocol
