#pragma once
#include <vector>

#include "station/core/problem.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/survey.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::protocol {

/// Warns about scenes whose tones, or the products that a slightly nonlinear amplifier adds to them, come
/// into the band of the force signal around the carrier of the rig's force cells. Such a product looks like
/// an oscillation of the force that follows the drive level. One warning per scene, about the product nearest
/// to the carrier. Empty for rigs without force cells, and for cells with a converter of their own, which
/// have no carrier.
std::vector<core::Problem> carrier_warnings(const Protocol& protocol, const rig::Rig& rig,
                                            const std::vector<Sight>& sights);

}  // namespace turnpoint::protocol
