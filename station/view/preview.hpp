#pragma once
#include <string>
#include <utility>
#include <vector>

#include "station/core/texts.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/following.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::view {

/// The options of `turnpoint preview`.
struct PreviewRequest {
  std::string protocol, rig, scene;  ///< `scene` is the name of the scene; "" for the first one
  std::vector<std::string> set;      ///< values of factors, each written as "factor=value"
};

/// A factor on which a scene depends, with the values that a slider for it can take.
struct Knob {
  std::string name;
  /// limits of the factor's range; without a range, its lowest and highest level
  double low = 0, high = 0;
  std::vector<double> levels;  ///< possible values; empty if any value in the range is allowed
  /// value to begin with: the first level, or the middle of the range if there are no levels
  double value = 0;
};

/// A scene as it is displayed: its plan, its displacement profile, and a description in words.
struct SceneLook {
  std::string scene;
  protocol::Factors factors;
  std::string problem;  ///< why this rig cannot present the scene; if not "", all members below are empty
  scene::DrivePlan plan;
  /// the surface without a finger, at kProfilePoints points, starting at the wide end
  scene::Planner::Profile profile;
  scene::UnderFinger under;
  std::optional<double> nearest_resonance_Hz;  ///< of a scene with one tone
  /// what a scene that follows the finger asks for and reaches, before its events; and, if it has any, after
  /// all of them
  std::vector<scene::FollowCurve> followed;
  /// facts about the scene and its cues, as pairs of a label and a value, in the order in which they are
  /// shown
  std::vector<std::pair<core::Phrase, core::Phrase>> facts, cues;
};

constexpr int kProfilePoints = 401;

/// Plans the scenes of a protocol on a rig, without a session. Not thread-safe.
class Preview {
 public:
  Preview(protocol::Protocol protocol, rig::Rig rig);

  const protocol::Protocol& protocol() const { return protocol_; }
  const rig::Rig& rig() const { return rig_; }
  /// Returns the scenes that the task presents, in the order of their names, and then the other scenes.
  std::vector<std::string> scenes() const;
  /// Returns the numeric factors on which the scene depends, directly or through its base scene. They come in
  /// the order of the protocol file.
  std::vector<Knob> knobs(const std::string& scene) const;

  /// Plans the scene. If the rig cannot present it, the result's `problem` gives the reason; no exception is
  /// thrown. Designing a zone takes up to a second, everything else some milliseconds. Throws
  /// std::out_of_range for an unknown scene.
  SceneLook look(const std::string& scene, const protocol::Factors& factors);

 private:
  protocol::Protocol protocol_;
  rig::Rig rig_;
  scene::Planner planner_;
};

/// Returns values for every factor. `set` contains texts of the form "factor=value". Each factor that `set`
/// does not name gets its first level or the middle of its range, and is listed in `assumed`. Throws
/// core::UsageError for a text of another form, an unknown factor, or a word where the factor needs a
/// number.
protocol::Factors factors_for(const protocol::Protocol& protocol, const std::vector<std::string>& set,
                              std::vector<std::string>& assumed);

/// Prepares a planned scene for display. `planner` must be the planner that made the plan; it computes the
/// profile.
SceneLook look_at(scene::DrivePlan plan, protocol::Factors factors, scene::Planner& planner);

}  // namespace turnpoint::view
