#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::rehearsal {

/// The cues of a scene for one set of factors. They can be read for any strength that roving may draw.
struct RovedCues {
  scene::Cues high;  ///< cues with the strength roved upwards by rove_dB
  /// cues with the strength roved downwards, if roving changes more than the strength
  std::optional<scene::Cues> low;
  double rove_dB = 0;

  /// Returns the cues of a trial whose displacement was roved by `drawn_dB`. Roving scales the amplitude and
  /// shifts the loudness. If the edge's position depends on the amplitude, the frequency changes as well, to
  /// keep the edge in place.
  scene::Cues at(double drawn_dB) const;
};

/// Finds the cues that a scene offers an observer, for any factors that a trial can have. The cues come from
/// one of three sources: the survey's plans; plans made here (at most 200 more, and none for zones, which
/// take long); or linear interpolation between plans. If the scene depends on a single sum of factors, the
/// table interpolates along that sum, otherwise along each factor.
class CueTable {
 public:
  CueTable(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey);

  /// Returns nothing if the scene can neither be planned nor interpolated.
  std::optional<RovedCues> find(const std::string& scene, const protocol::Factors& factors);

 private:
  struct Entry {
    std::vector<double> values;  ///< values of the scene's factors, in the order of their names
    double sum = 0;              ///< value of the one expression in the scene that contains factors
    RovedCues cues;
  };
  struct SceneEntries {
    std::vector<std::string> factors;
    /// the scene's expression that depends on factors; null if several do
    const protocol::Linear* only = nullptr;
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

}  // namespace turnpoint::rehearsal
