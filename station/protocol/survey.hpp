#pragma once
#include <optional>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/cues.hpp"

namespace turnpoint::protocol {

/// One combination of factors in which a scene occurs, and what the planner made of it.
struct Sight {
  std::string scene;
  std::string block;
  Factors factors;  ///< those on which the scene depends
  double lowest_Hz = 0, highest_Hz = 0;
  std::optional<double> boundary_mm;
  double displacement_um = 0;  ///< largest anywhere on the surface, roving upwards
  double lowest_friction = 1;
  std::string model;
  double error_bound_mm = 0;
  bool inside_tolerance = true;
  scene::Cues cues;  ///< with the strength roved upwards
  /// With the strength roved downwards, where that moves more than the strength: edges by friction.
  std::optional<scene::Cues> cues_roved_down;
};

/// What a protocol asks of a rig. Problems prevent a session, warnings do not.
struct Survey {
  std::vector<text::Problem> problems, warnings;
  std::vector<Sight> sights;     ///< in file order of blocks; each combination once
  std::size_t combinations = 0;  ///< how many there are; above the number planned, the extremes were taken
  std::set<std::string> models;
};

/// Thrown by work that was asked to stop before it had a result.
class Abandoned : public std::runtime_error {
 public:
  Abandoned() : std::runtime_error("abandoned before it had a result") {}
};

/// Plans every scene for the combinations of factors that can occur (a staircase by its limits), and checks
/// devices, limits and levels. Beyond 120 combinations of a scene, 36 of one with a zone, or 6 of one
/// with a zone that depends on one sum of factors, it takes the extremes and even steps between them:
/// sights.size() against combinations says so. Throws Abandoned soon after `stop` asks it to (within the plan
/// at hand).
Survey survey(const Protocol& protocol, const rig::Rig& rig, const std::stop_token& stop = {});

/// What is probably not meant, whatever the rig, each at the line of its key: levels that the tolerance hides
/// or everybody feels, answers that are never right, practice that one key passes, steps and rates that do
/// not fit the task, times in other units, breaks that never come, parts that nothing uses.
std::vector<text::Problem> advice(const Protocol& protocol);

}  // namespace turnpoint::protocol
