#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/follow/pattern.hpp"
#include "station/protocol/linear.hpp"
#include "station/scene/scene.hpp"

namespace turnpoint::protocol {

/// How the values of a factor are drawn if nothing else sets the factor.
enum class FactorDraw {
  levels,              ///< one of the levels in each trial; a factor with a range is not drawn
  without_repetition,  ///< the levels in shuffled order; each once before any comes again
  uniform,             ///< uniform over the range
  normal,              ///< normal; values outside of the range are drawn again
  per_participant      ///< each participant has one of the levels in all sessions: a group
};

struct Factor {
  std::string name;
  FactorDraw draw = FactorDraw::levels;
  double mean = 0, sd = 0;  ///< mean and standard deviation, if `draw` is FactorDraw::normal
  std::optional<std::pair<double, double>> range;
  std::vector<FactorValue> levels;
  Place place;
};

/// What counts as the edge of a scene's vibration: a named point (turning, peak, p70, p50, p25 or p10), or
/// the place with a given relative friction.
struct Edge {
  std::string name;                ///< "friction" for an edge defined by friction
  std::optional<double> friction;  ///< relative friction in (0, 1)
};

/// One tone that a scene lists in `tones`, placed by boundary or by frequency.
struct SceneTone {
  std::optional<Linear> boundary_mm, frequency_Hz;
  Edge edge;
  Linear displacement_um;
  double phase_deg = 0;
};

struct Zone {
  std::optional<double> from_mm;
  std::optional<Linear> friction;
  /// the friction for which the zone's tones are designed: that of the base scene's zone if it has one,
  /// otherwise that of the scene's own zone
  std::optional<Linear> design_friction;
  std::optional<int> tones;
};

/// What makes a part of a following scene begin, and how long it lasts.
struct FollowEvent {
  follow::Event event = follow::Event::none;
  std::optional<Linear> threshold;  ///< in N, mm or mm/s; empty for none and contact
  follow::Until until = follow::Until::released;
  std::optional<Linear> delay_s, lasts_s;
};

/// Noise as a sum of sines: power density (any unit) at cycles per mm, joined by straight lines.
struct Noise {
  std::vector<follow::SpectrumPoint> spectrum;
  std::optional<Linear> instance;  ///< which one of the noises with this spectrum
};

/// One part of what the gain follows; the same as follow::Part, with expressions. Values are in the unit of
/// the scene's `follow`.
struct FollowPart {
  follow::Shape shape = follow::Shape::constant;  ///< `table` also for noise
  follow::Combine combine = follow::Combine::replace;
  std::optional<Linear> from, to, begin_mm, end_mm, period_mm, frequency_Hz, phase_deg, place_mm, width_mm;
  std::vector<double> samples;  ///< one cycle of a table
  std::optional<Noise> noise;
  FollowEvent event;
  Place place;
};

/// What the gain of a scene's tones follows; see scene::FollowTarget.
struct Follow {
  scene::FollowUnit unit = scene::FollowUnit::relative;
  Linear base;  ///< the value where no part acts
  follow::Control control = follow::Control::open;
  std::optional<Linear> resting_friction;
  double resting_gain = 0;
  std::vector<FollowPart> parts;
  Place place;
};

/// The accuracy that a scene requires. The planner uses the cheapest model that meets all tolerances that are
/// given.
struct Tolerance {
  std::optional<double> boundary_mm, level_dB, friction;
};

/// A scene after its `base` has been merged in. It describes what one interval presents. Its expressions
/// still contain factors.
struct Scene {
  std::string name, base;
  std::optional<Linear> boundary_mm;
  Edge edge;
  /// strength at the last maximum of the vibration; at most one of displacement_um, friction and
  /// displacement_under_finger_um is set
  std::optional<Linear> displacement_um, friction;
  /// displacement under a finger at position `finger_mm`
  std::optional<Linear> displacement_under_finger_um, finger_mm;
  std::vector<SceneTone> tones;
  std::optional<Zone> zone;
  /// how far the friction is below that of the base scene, in dB: 20 log10(difference / friction of the base
  /// scene)
  std::optional<Linear> friction_contrast_dB;
  /// in each trial the displacement is changed by a random value, uniform between -rove_dB and +rove_dB
  double rove_dB = 0;
  double ramp_ms = 50;
  Tolerance tolerance;
  std::optional<Follow> follow;
  Place place;
};

}  // namespace turnpoint::protocol
