#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/finger.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Converts the rig's finger to the type of the physics library.
physics::Finger finger_of(const rig::Rig& rig);

/// Returns the rig's finger, followed by fingers that differ from it by one standard deviation in impedance
/// and phase.
std::vector<physics::Finger> fingers_of(const rig::Rig& rig);

/// For a tone with an amplitude of 1 at the drive edge: the displacement without a finger at evenly spaced
/// points along the surface, ends included, and the share of it that the rig's finger leaves under its whole
/// contact at each point, as finger_figures() takes them for friction. Takes some 0.1 s.
struct ToneUnderFinger {
  std::vector<double> x_m, displacement, share;
};
ToneUnderFinger tone_under_finger(const physics::Surface& surface, const rig::Rig& rig, physics::Model model,
                                  double frequency_Hz);

/// How far a moving finger shifts an edge, positive towards the narrow tip of the surface, and the range of
/// this shift over all fingers from fingers_of().
struct FingerShift {
  double shift_m = 0, least_m = 0, most_m = 0;
};

/// Returns how far the rig's finger shifts this edge for a tone of this frequency. Empty if the edge is not a
/// peak or a percentage, or if there is no such edge under a finger.
std::optional<FingerShift> finger_shift(const rig::Rig& rig, double frequency_Hz, const physics::Edge& edge);

/// What the surface's uncertain parameters do to a tone's level at a position of the free surface, with the
/// part of each of them or without. Empty if no parameter has a standard deviation, or if one is so large
/// that some surface could not exist.
enum class Parts { left_out, wanted };
std::optional<physics::LevelBudget> level_of(const physics::Surface& surface, double frequency_Hz,
                                             double at_m, Parts parts);

struct FingerSolution;

/// Computes the result of Planner::under_finger() for a surface whose plate theory is already chosen. Plans
/// that differ only in the amplitude of their tones have the same solution, which is kept.
class FingerFigures {
 public:
  UnderFinger of(const physics::Surface& surface, const physics::FrictionMap& friction, const rig::Rig& rig,
                 physics::Model field_model, const DrivePlan& plan);

 private:
  std::map<std::string, std::shared_ptr<const FingerSolution>> known_;
};

/// The fraction of a tone's displacement that is left under the rig's finger, when the finger is at the
/// tone's last maximum along the surface. The two values are the smallest and the largest over the tones.
struct FingerShares {
  double least = 1, most = 0;
  /// the larger standard deviation of the level there, from the rig's uncertain parameters; see level_of()
  std::optional<double> level_sd_dB = {};
};

/// Returns the fractions of the displacement that remain under a finger, for tones of these frequencies;
/// empty if no tone has a last maximum. Takes 5 ms per tone, on a thick plate 0.1 s.
std::optional<FingerShares> finger_shares(const rig::Rig& rig, const std::vector<double>& frequencies_Hz);

}  // namespace turnpoint::scene
