#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::simulation {

/// The cues of a scene for one set of factors, whatever strength is drawn for the trial.
struct RovedCues {
  scene::Cues high;                ///< with the strength roved upwards by rove_dB
  std::optional<scene::Cues> low;  ///< roved downwards, where that moves more than the strength
  double rove_dB = 0;

  /// With this much drawn: roving scales the amplitude and shifts the loudness, and moves the frequency where
  /// the edge depends on strength.
  scene::Cues at(double drawn_dB) const;
};

/// What the task's scenes offer to an observer of cues, for any factors that a trial can have: as the survey
/// planned it, else planned here (at most 200 more, and no zones, which take long), else by linear
/// interpolation between plans, along the one sum of factors on which the scene depends or along each factor.
class CueTable {
 public:
  CueTable(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey);

  /// None: the scene cannot be planned, nor lies between plans.
  std::optional<RovedCues> find(const std::string& scene, const protocol::Factors& factors);

 private:
  struct Entry {
    std::vector<double> values;  ///< of the scene's factors, in the order of their names
    double sum = 0;              ///< of the scene's only expression with factors
    RovedCues cues;
  };
  struct SceneEntries {
    std::vector<std::string> factors;
    const protocol::Linear* only = nullptr;  ///< where one expression alone depends on factors
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
