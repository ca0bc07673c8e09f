#pragma once
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::desk {

/// The options of `turnpoint preview`.
struct PreviewRequest {
  std::string protocol, rig, scene;  ///< name of the scene; "" for the first one
  std::vector<std::string> set;      ///< "factor=value"
};

/// A factor that a scene depends on, as an adjustable value.
struct Knob {
  std::string name;
  double low = 0, high = 0;    ///< limits of the factor's range, or of its levels
  std::vector<double> levels;  ///< possible values; empty if any value within the range is allowed
  double value = 0;            ///< first level, or else the middle of the range
};

/// A scene prepared for display: its plan, its displacement profile, and a textual description.
struct SceneLook {
  std::string scene;
  protocol::Factors factors;
  std::string problem;  ///< why this rig cannot present it; if set, everything below is empty
  scene::DrivePlan plan;
  scene::Planner::Profile profile;  ///< 401 points from the wide end
  /// (label, value), in reading order.
  std::vector<std::pair<std::string, std::string>> facts, cues;
};

/// Number of points in a profile.
constexpr int kProfilePoints = 401;

/// The scenes of a protocol on a rig, without a session. Not thread-safe.
class Preview {
 public:
  /// Throws text::BadInput with all problems of both files, or std::system_error if one cannot be read.
  Preview(const std::string& protocol_path, const std::string& rig_path);
  Preview(protocol::Protocol protocol, rig::Rig rig);

  const protocol::Protocol& protocol() const { return protocol_; }
  const rig::Rig& rig() const { return rig_; }
  /// First the scenes that the task presents, in the order of their names, then the others.
  std::vector<std::string> scenes() const;
  /// The numeric factors that the scene or its base depends on, in file order.
  std::vector<Knob> knobs(const std::string& scene) const;

  /// Plans the scene. If the rig cannot present it, that is reported in the result's `problem`, not as an
  /// exception. Designing a zone takes up to a second, everything else some milliseconds. Throws
  /// std::out_of_range for an unknown scene.
  SceneLook look(const std::string& scene, const protocol::Factors& factors);

 private:
  protocol::Protocol protocol_;
  rig::Rig rig_;
  scene::Planner planner_;
};

/// Values for every factor. `set` contains "factor=value" texts; other factors get their first level, or else
/// the middle of their range, and are listed in `assumed`. Throws terms::UsageError for a text that is not
/// understood.
protocol::Factors factors_for(const protocol::Protocol& protocol, const std::vector<std::string>& set,
                              std::vector<std::string>& assumed);

/// A planned scene prepared for display: its profile from the planner that made it, and a textual
/// description.
SceneLook look_at(scene::DrivePlan plan, protocol::Factors factors, scene::Planner& planner);

}  // namespace turnpoint::desk
