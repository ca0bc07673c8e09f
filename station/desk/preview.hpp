#pragma once
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::desk {

/// What `turnpoint preview` was asked for.
struct PreviewRequest {
  std::string protocol, rig, scene;  ///< scene "": the first
  std::vector<std::string> set;      ///< "factor=value"
};

/// A factor that a scene depends on, as something to turn.
struct Knob {
  std::string name;
  double low = 0, high = 0;    ///< of its range, or of its levels
  std::vector<double> levels;  ///< empty: anything within the range
  double value = 0;            ///< first level, else the middle of the range
};

/// What a scene is on the surface, for eyes: plan, profile, and both in words.
struct SceneLook {
  std::string scene;
  protocol::Factors factors;
  std::string problem;  ///< why this rig cannot present it; then everything below is empty
  scene::DrivePlan plan;
  scene::Planner::Profile profile;  ///< 401 points from the wide end
  /// (label, value), in the order to be read.
  std::vector<std::pair<std::string, std::string>> facts, cues;
};

/// A profile has so many points.
constexpr int kProfilePoints = 401;

/// The scenes of a protocol on a rig, before anyone is in the room. Not thread-safe.
class Preview {
 public:
  /// Throws text::BadInput with all problems of both files, std::system_error where one cannot be read.
  Preview(const std::string& protocol_path, const std::string& rig_path);
  Preview(protocol::Protocol protocol, rig::Rig rig);

  const protocol::Protocol& protocol() const { return protocol_; }
  const rig::Rig& rig() const { return rig_; }
  /// Those that the task presents, in the order of their names, then the others.
  std::vector<std::string> scenes() const;
  /// Numeric factors that the scene depends on, in file order; its base's included.
  std::vector<Knob> knobs(const std::string& scene) const;

  /// Plans the scene; what the rig cannot do is the look's problem, not an exception. A zone's inverse design
  /// takes up to a second, everything else some milliseconds. Throws std::out_of_range for an unknown scene.
  SceneLook look(const std::string& scene, const protocol::Factors& factors);

 private:
  protocol::Protocol protocol_;
  rig::Rig rig_;
  scene::Planner planner_;
};

/// Values for every factor: `set` holds "factor=value" texts, others take their first level, else the middle
/// of their range, and are listed in `assumed`. Throws terms::UsageError for a text that is neither.
protocol::Factors factors_for(const protocol::Protocol& protocol, const std::vector<std::string>& set,
                              std::vector<std::string>& assumed);

/// A planned scene for eyes: its profile by the planner that made it, and both in words.
SceneLook look_at(scene::DrivePlan plan, protocol::Factors factors, scene::Planner& planner);

}  // namespace turnpoint::desk
