#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::simulation {

/// The cues of a scene for one set of factors, for any strength that may be drawn.
struct RovedCues {
  scene::Cues high;  ///< with the strength roved upwards by rove_dB
  /// with the strength roved downwards, if that changes more than the strength
  std::optional<scene::Cues> low;
  double rove_dB = 0;

  /// The cues with this draw. Roving scales the amplitude and shifts the loudness; it changes the frequency
  /// if the edge depends on the strength.
  scene::Cues at(double drawn_dB) const;
};

/// The cues that the task's scenes offer an observer, for any factors that a trial can have. They come from
/// the survey's plans, from plans made here (at most 200 more, and not for zones, which take long), or from
/// linear interpolation between plans: along the single sum of factors on which the scene depends, or along
/// each factor.
class CueTable {
 public:
  CueTable(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey);

  /// Empty: the scene can neither be planned nor interpolated.
  std::optional<RovedCues> find(const std::string& scene, const protocol::Factors& factors);

 private:
  struct Entry {
    std::vector<double> values;  ///< values of the scene's factors, in the order of their names
    double sum = 0;              ///< value of the scene's only expression with factors
    RovedCues cues;
  };
  struct SceneEntries {
    std::vector<std::string> factors;
    const protocol::Linear* only = nullptr;  ///< set if a single expression depends on factors
    std::vector<Entry> entries;
  };
  static std::optional<RovedCues> between(const std::vector<const Entry*>& entries,
                                          const std::vector<double>& wanted, std::size_t axis);

  std::optional<RovedCues> planned(const std::string& scene, const protocol::Factors& factors);

  const protocol::Protocol& protocol_;
  scene::Planner planner_;
  int plans_left_ = 200;
  std::map<std::string, SceneEntries> scenes_;
};

}  // namespace turnpoint::simulation
