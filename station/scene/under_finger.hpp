#pragma once
#include <optional>
#include <vector>

#include "physics/finger.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Converts the rig's finger to the type of the physics library.
physics::Finger finger_of(const rig::Rig& rig);

/// The rig's finger first, then those one standard deviation away from it in impedance and phase.
std::vector<physics::Finger> fingers_of(const rig::Rig& rig);

/// How far a moving finger displaces an edge, positive towards the tip, with the range over fingers_of().
struct FingerShift {
  double shift_m = 0, least_m = 0, most_m = 0;
};

/// Returns the shift at one frequency, or nothing if the edge is not a peak or a percentage, or if a finger
/// leaves no such edge.
std::optional<FingerShift> finger_shift(const rig::Rig& rig, double frequency_Hz, const physics::Edge& edge);

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
