#pragma once
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "physics/boundary_budget.hpp"
#include "physics/boundary_map.hpp"
#include "physics/crest.hpp"
#include "physics/friction.hpp"
#include "physics/model.hpp"
#include "physics/planner.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "physics/warning.hpp"
#include "station/core/texts.hpp"
#include "station/follow/follower.hpp"
#include "station/rig/physical.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/cues.hpp"
#include "station/scene/scene.hpp"

namespace turnpoint::scene {

/// Thrown for a scene that this rig cannot present. The message says why, and what would be possible.
class Unreachable : public core::Refusal {
 public:
  using Refusal::Refusal;
};

/// One tone of a plan: the motion of the drive edge, the transducer that causes it, and what it does to the
/// surface.
struct PlannedTone : physics::Tone {
  std::string transducer = {};
  int channel = 0;
  double full_scale = 0;  ///< peak value of the tone at the converter; 1 is full scale
  /// phase at the converter: `phase_rad` minus the phase shift of the transducer
  double output_phase_rad = 0;
  std::optional<double> turning_point_m = {}, last_peak_m = {};
  /// peak displacement at the tone's last maximum, or the largest peak displacement if there is no maximum
  double displacement_m = 0;
  double gain = 0;
  /// standard deviation of the level at the last maximum; see level_of(), set by add_level_uncertainty()
  std::optional<double> level_sd_dB = {};
};

/// How this rig presents a scene: the tones, the chosen model with the reason and its error bounds, and the
/// predicted behaviour of the surface. The error of the model and the uncertainty from the rig's parameters
/// are separate.
struct DrivePlan {
  Scene scene;
  std::vector<PlannedTone> tones;  ///< all tones, in order of falling frequency
  physics::Model model = physics::Model::mode;
  bool inside_tolerance = true;
  core::Phrase beyond_tolerance;  ///< says which error bounds are too large; empty if inside_tolerance
  double error_bound_m = 0;       ///< upper limit of the model's error in the boundary's position
  double level_bound_dB = 0;      ///< upper limit of the model's error in the level at the last maximum
  double amplitude_bound = 0;     ///< upper limit of the model's relative error in the amplitude
  /// standard deviation of the boundary's position, from the standard deviations in the rig file
  double uncertainty_m = 0;
  std::string reason;    ///< why the planner chose this model
  core::Phrase cheaper;  ///< the most exact one of the cheaper models, and which tolerances it would miss
  /// the plate theory used, if the surface is a plate
  physics::PlateTheory theory = physics::PlateTheory::kirchhoff;
  /// How far the boundary would move with the next more exact plate theory; empty for membranes.
  std::optional<double> shear_shift_m;
  std::optional<double> boundary_m;     ///< predicted position of the boundary
  std::optional<double> zone_friction;  ///< predicted mean friction of the zone
  std::optional<double> residual;       ///< rms deviation of friction from its mean within the zone
  /// lowest friction anywhere on the surface, averaged over the fingertip
  double lowest_friction = 1;
  /// largest displacement anywhere on the surface, if all tones were in phase
  double peak_displacement_m = 0;
  double peak_full_scale = 0;  ///< largest value at any converter channel, if all tones were in phase
  double crest_factor = 0;
  std::vector<physics::Product> audible_products;
  Cues cues;
  std::vector<physics::Warning> warnings;
  /// how the gain follows the finger; empty if the scene does not ask for it
  std::shared_ptr<const follow::Plan> follow;
};

/// A planned scene under the rig's finger. The drive is the same as without a finger. Displacements are means
/// over the finger's contact, combined over the tones as the root of summed squares. Friction is averaged
/// over the fingertip.
struct UnderFinger {
  /// position of the finger: as the scene says, or at the last maximum of the highest tone
  double finger_m = 0;
  double free_m = 0;          ///< displacement of the surface at `finger_m` without a finger
  double displacement_m = 0;  ///< displacement of the surface at `finger_m` under the finger
  /// smallest and largest displacement under fingers that differ from the rig's finger by one standard
  /// deviation
  double least_m = 0, most_m = 0;
  /// relative friction at `finger_m`: from the vibration without a finger, and from the vibration under the
  /// finger
  double free_friction = 1, friction = 1;
  /// What the rig's uncertain parameters do to the highest tone's level at `finger_m`, and the 95 % interval
  /// of the friction under the finger there if the levels of all tones move with it; see level_of().
  std::optional<physics::LevelBudget> level;
  double friction_low = 1, friction_high = 1;
  double lowest_friction = 1;  ///< lowest relative friction that the finger meets at any position
  /// for a finger in the zone: mean friction, and rms deviation from this mean
  std::optional<double> zone_friction, residual;
  /// how far the boundary of the highest tone shifts under a moving finger
  std::optional<double> boundary_shift_m;
  /// positions along the surface, and the friction under a finger at each of them
  std::vector<double> profile_x_m, profile_friction;
};

/// Turns scenes into drive plans for one rig. The result of plan() depends only on the scene and the rig; the
/// planner caches boundary maps and designs only to save time. Not thread-safe.
class Planner {
 public:
  explicit Planner(const rig::Rig& rig);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;
  /// Copies the planner with its caches, so that another thread can use the copy.
  Planner(const Planner& other);

  /// Returns the plan with the cheapest model that meets the scene's tolerance. Throws Unreachable if the
  /// surface, a transducer's band, the converter or the rig's limits cannot present the scene.
  DrivePlan plan(const Scene& scene);

  /// At evenly spaced points along the surface, ends included: the displacement of a plan (m, root of summed
  /// squares over the tones) and the friction averaged over the fingertip.
  struct Profile {
    std::vector<double> x_m, displacement_m, friction;
  };
  Profile profile(const DrivePlan& plan, int points);

  /// The resonance that is nearest to one of the plan's frequencies, by the plan's theory. Takes some 20 ms
  /// on a thick plate.
  std::optional<double> nearest_resonance_Hz(const DrivePlan& plan, double frequency_Hz);

  /// Sets `level_sd_dB` of all tones. It is computed at frequencies that are 0.5 % apart, once for each: some
  /// 15 ms, on a thick plate 30 ms.
  void add_level_uncertainty(DrivePlan& plan);

  /// Computes the plan's scene under a finger. Takes some 100 ms; on a thick plate 1 s per tone.
  UnderFinger under_finger(const DrivePlan& plan);

  const physics::Surface& surface() const;
  const physics::FrictionMap& friction() const;

 private:
  struct State;
  DrivePlan make(const Scene& scene);
  Planner& by_theory(physics::PlateTheory theory);
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::scene
