#pragma once
#include <optional>
#include <vector>

#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "station/core/texts.hpp"
#include "station/follow/follower.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Displacement of the surface without a finger (m, peak, root of summed squares over the tones) at ascending
/// places, at full gain, and the share of it that the rig's finger leaves under its fingertip at each place.
struct FingerField {
  std::vector<double> x_m, displacement_m, finger_share;
};

/// The largest distance of a tone from a resonance at which the plate's envelope is that of `follow`: half of
/// the resonance's width, f / (2 Q). There a step of the drive overshoots by exp(-pi) = 4 %.
double most_detuning_Hz(double quality_factor, double frequency_Hz);

/// The distance of a resonance that is nearest to a tone; empty if there is none.
struct Detuning {
  double frequency_Hz = 0;
  std::optional<double> resonance_Hz;
};

/// Prepares how the gain of a plan follows the finger. Throws Unreachable in plain words if the rig cannot:
/// without captured force cells whose resonance is known, with too long a delay, with tones too near to the
/// cells' carrier, away from a resonance, or of different time constants, with a texture that the plate
/// cannot present at the speeds that the scene asks for in either direction, with something that is too fast
/// for the cells, with a part that lies where it does not act or an event that no finger reaches, and where a
/// part with begin and end asks for friction that cannot be reached between them.
std::shared_ptr<const follow::Plan> follow_plan(const rig::Rig& rig, const physics::FrictionMap& friction,
                                                const DrivePlan& plan, const FingerField& field,
                                                const std::vector<Detuning>& detunings);

/// What a texture of a plan allows.
struct TextureFigures {
  int part = 0;         ///< index in the pattern
  double place_m = 0;   ///< the place of those that were tried at which it can follow least
  double period_m = 0;  ///< 0 for one that varies only in time
  /// the highest frequency at which the amplitude can vary by 90 % of what `from` and `to` ask for there
  double bandwidth_Hz = 0;
  /// The fastest finger that still feels it at all of these places and in both directions (see
  /// follow::presented(); up to 1 m/s); empty if no finger does, or if it varies only in time.
  std::optional<double> most_speed_m_s;
};

/// What a plan that follows can and cannot do.
struct FollowFigures {
  follow::Delay delay;
  double time_constant_s = 0;
  std::optional<double> loop_cutoff_Hz;  ///< of a closed loop
  std::vector<follow::Unmet> unmet;
  std::vector<TextureFigures> textures;
};
/// Takes some 0.1 s for each texture. The plan must follow.
FollowFigures follow_figures(const DrivePlan& plan);

/// Where a plan asks for what it cannot present, by more than 0.02 of the friction at rest, or of the largest
/// displacement; see follow::unmet().
std::vector<follow::Unmet> unmet_of(const DrivePlan& plan);
/// Says so for people, in the unit of the scene: the stretch, what is asked for, and what is reached there.
core::Phrase in_words(const DrivePlan& plan, const follow::Unmet& unmet);

/// What a person should know about a plan although the rig can present it: force cells that are slow, a
/// texture for which no speed is given, or a coefficient of friction without that of the surface at rest.
std::optional<core::Phrase> remark_on(const rig::Rig& rig, const DrivePlan& plan);

/// What is asked for and what is reached, along the surface, in the unit of the scene (displacements in m),
/// at time 0: `begun` says whether all events have happened.
struct FollowCurve {
  std::vector<double> x_m, asked, reached;
};
enum class Events { none, all };
FollowCurve follow_curve(const DrivePlan& plan, int points, Events events);

/// For the plan's cues: the root of the mean square of the gain along the strip, over all phases of textures
/// that move, without the events and (if there are any) with all of them, to which the square of the resting
/// gain is added, which sounds before touch; the largest of all these gains; and the lowest friction.
struct FollowedGains {
  double rms = 0, most = 0, lowest_friction = 1;
};
FollowedGains followed_gains(const follow::Plan& plan);

}  // namespace turnpoint::scene
