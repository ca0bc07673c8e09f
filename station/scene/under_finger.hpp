#pragma once
#include <optional>

#include "physics/finger.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Converts the rig's finger to the type of the physics library.
physics::Finger finger_of(const rig::Rig& rig);

/// Computes the result of Planner::under_finger() for a surface whose plate theory is already chosen.
UnderFinger finger_figures(const physics::Surface& surface, const physics::FrictionMap& friction,
                           const rig::Rig& rig, physics::Model field_model, const DrivePlan& plan);

/// The smallest and the largest share of its displacement that a tone keeps under the rig's finger, each tone
/// at its last maximum.
struct FingerShares {
  double least = 1, most = 0;
};

/// Returns the shares, or nothing if no tone has a last maximum. A tone takes 5 ms, on a thick plate 0.1 s.
std::optional<FingerShares> finger_shares(const rig::Rig& rig, const std::vector<double>& frequencies_Hz);

}  // namespace turnpoint::scene
