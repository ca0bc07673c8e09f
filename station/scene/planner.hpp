#pragma once
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "physics/boundary_map.hpp"
#include "physics/crest.hpp"
#include "physics/friction.hpp"
#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/warning.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/cues.hpp"
#include "station/scene/scene.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::scene {

/// A scene that this rig cannot present; the message names what, and what could be.
class Unreachable : public terms::UsageError {
 public:
  using terms::UsageError::UsageError;
};

/// One tone as the drive will play it.
struct DrivenTone {
  double frequency_Hz = 0;
  double amplitude_m = 0;  ///< peak displacement of the drive edge
  double phase_rad = 0;    ///< of the drive edge
  std::string transducer;
  int channel = 0;
  double full_scale = 0;             ///< peak at the converter, 1 is full scale
  double output_phase_rad = 0;       ///< at the converter: the transducer's phase taken off
  std::optional<double> boundary_m;  ///< by the scene's edge, for this tone alone
  std::optional<double> turning_point_m, last_peak_m, nearest_resonance_Hz;
  double displacement_m = 0;  ///< peak at its last maximum (largest value where there is none)
  double gain = 0;
};

/// Everything about a scene on this rig: the tones, the model that was enough and why, what it promises, and
/// what the surface will do. Model error and parameter uncertainty stay two numbers.
struct DrivePlan {
  Scene scene;
  std::vector<DrivenTone> tones;  ///< highest frequency first
  physics::Model model = physics::Model::mode;
  bool inside_tolerance = true;
  double error_bound_m = 0;             ///< of the boundary, by the model
  double level_bound_dB = 0;            ///< of the last maximum, by the model
  double amplitude_bound = 0;           ///< relative, by the model
  double uncertainty_m = 0;             ///< of the boundary, by the rig's tolerances
  std::string reason;                   ///< why this model
  std::optional<double> boundary_m;     ///< reached
  std::optional<double> zone_friction;  ///< reached mean over the zone
  std::optional<double> residual;       ///< rms of friction about its mean in the zone
  double lowest_friction = 1;           ///< fingertip average, anywhere on the surface
  double peak_displacement_m = 0;       ///< anywhere on the surface, tones summed in phase
  double peak_full_scale = 0;           ///< largest over channels, tones summed in phase
  double crest_factor = 0;
  std::vector<physics::Product> audible_products;
  Cues cues;
  std::vector<physics::Warning> warnings;
};

/// Turns scenes into drive plans for one rig. plan() is pure in its result (it only remembers boundary maps
/// and designs that it has made); not thread-safe.
class Planner {
 public:
  explicit Planner(const rig::Rig& rig);
  ~Planner();
  Planner(Planner&&) noexcept;
  /// With what the other remembers, for another thread.
  Planner(const Planner& other);

  /// The cheapest plan inside the scene's tolerance. Throws Unreachable where the surface, a transducer's
  /// band, the converter or the rig's limits do not allow the scene.
  DrivePlan plan(const Scene& scene);

  /// The plan's displacement profile at n points from 0 to length inclusive, root of summed squares (m), and
  /// friction averaged over the fingertip.
  struct Profile {
    std::vector<double> x_m, displacement_m, friction;
  };
  Profile profile(const DrivePlan& plan, int points);

  const physics::Surface& surface() const;
  const physics::FrictionMap& friction() const;

 private:
  struct State;
  DrivePlan make(const Scene& scene);
  std::unique_ptr<State> state_;
};

/// The rig's surface and friction map as physics sees them. Throws std::invalid_argument.
physics::Surface surface_of(const rig::Rig& rig);
physics::FrictionMap friction_of(const rig::Rig& rig);

}  // namespace turnpoint::scene
