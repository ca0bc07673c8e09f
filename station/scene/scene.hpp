#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "physics/edge.hpp"
#include "station/follow/follower.hpp"

namespace turnpoint::scene {

/// A tone that a scene asks for. In a scene, exactly one of its boundary and its frequency is set. The
/// planner finds the frequency of a tone with a boundary from the surface's first mode.
struct ToneTarget {
  std::optional<double> boundary_m, frequency_Hz;
  physics::Edge edge;
  double displacement_m = 0;  ///< peak displacement at the tone's last maximum along the surface
  double phase_rad = 0;
};

/// A zone of uniform friction from `from_m` to the scene's boundary.
struct ZoneTarget {
  double from_m = 0;
  double friction = 1;  ///< desired mean over the zone, relative to the friction of the surface at rest
  int tones = 1;        ///< largest number of tones that may be used
  /// if set, the tones are designed for this friction, and then their amplitudes are scaled to give
  /// `friction`
  std::optional<double> design_friction;
};

/// A displacement that is wanted under the rig's finger, as a mean over the finger's contact. The drive is
/// computed for a finger at `finger_m` and does not change when the finger moves.
struct FingerTarget {
  double displacement_m = 0;
  double finger_m = 0;  ///< position of the finger for which the drive is computed
};

/// The accuracy that a scene requires of its plan. An empty value means no requirement.
struct Tolerance {
  std::optional<double> boundary_m, level_dB, friction;
};

/// In which unit a scene states what the gain is to follow: friction relative to that of the surface at rest,
/// the coefficient of friction, or displacement under the finger.
enum class FollowUnit { relative, coefficient, displacement };

/// What the gain of all tones is to follow. A gain of 1 is the strength that the scene states, and the
/// largest that is used.
struct FollowTarget {
  /// in SI units; friction as its coefficient, also if `unit` is `relative` (then times `resting_friction`)
  follow::Pattern pattern;
  FollowUnit unit = FollowUnit::relative;
  follow::Control control = follow::Control::open;
  /// coefficient of friction of the surface at rest; empty if the protocol does not state it, and then all
  /// values of friction are relative to it
  std::optional<double> resting_friction;
  double resting_gain = 0;      ///< without a finger, and after a fault
  /// the range of speeds that the protocol asks for; empty if it asks for none
  std::optional<std::pair<double, double>> speeds_m_s;
};

/// What one interval presents on the surface, in SI units: either a boundary alone, or explicit tones, or a
/// zone (which also has a boundary).
struct Scene {
  std::string name;
  std::optional<double> boundary_m;
  physics::Edge edge;
  /// strength, given by values at the last maximum of the vibration without a finger. If the scene gives only
  /// a boundary, exactly one of displacement_m, friction and under_finger is set.
  std::optional<double> displacement_m, friction;
  std::optional<FingerTarget> under_finger;
  std::vector<ToneTarget> tones;
  std::optional<ZoneTarget> zone;
  double rove_dB = 0;  ///< random change of all displacements, drawn for this trial
  double ramp_s = 0.050;
  Tolerance tolerance;
  std::shared_ptr<const FollowTarget> follow;  ///< empty if the strength stays as it is
};

}  // namespace turnpoint::scene
