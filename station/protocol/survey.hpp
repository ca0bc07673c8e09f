#pragma once
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include "physics/model.hpp"
#include "physics/tone.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/cues.hpp"

namespace turnpoint::protocol {

/// One combination of factors in which a scene occurs, with the planner's results.
struct Sight {
  std::string scene;
  std::string block;
  Factors factors;  ///< the factors on which the scene depends
  double lowest_Hz = 0, highest_Hz = 0;
  std::vector<physics::Tone> tones;  ///< tones at the drive edge, at the largest strength that rove_dB allows
  physics::Model field_model = physics::Model::mode;
  std::optional<double> boundary_mm;
  /// largest displacement anywhere on the surface, at the largest strength that rove_dB allows
  double displacement_um = 0;
  double lowest_friction = 1;
  std::string model;
  double error_bound_mm = 0;
  /// standard deviation of the boundary, computed from the standard deviations in the rig file
  double uncertainty_mm = 0;
  bool inside_tolerance = true;
  scene::Cues cues;  ///< properties that could give the answer away, at the largest strength
  /// The cues at the smallest strength that rove_dB allows. Set only for edges defined by friction, because
  /// there the random change of strength changes the edge too.
  std::optional<scene::Cues> cues_roved_down;
};

/// The result of checking a protocol against a rig. Problems prevent a session, warnings do not.
struct Survey {
  std::vector<core::Problem> problems, warnings;
  std::vector<Sight> sights;  ///< in the order of blocks in the file; each combination appears once
  /// number of combinations that can occur; if `sights` has fewer, only the extremes and evenly spaced values
  /// between them were planned
  std::size_t combinations = 0;
  std::set<std::string> models;
  /// Of a file with several tasks: the survey of each, without advice; `sights` has those of all.
  std::vector<Survey> by_task;
};

/// Thrown if survey() is stopped before it has a result.
class Abandoned : public std::runtime_error {
 public:
  Abandoned() : std::runtime_error("the check of the protocol was stopped before it had a result") {}
};

/// Plans every scene for the combinations of factors that can occur (for a staircase: for its limits), and
/// checks devices, limits and levels. If a scene has more than 120 combinations (36 with a zone, 6 with a
/// zone that depends on a single expression), only the extremes and evenly spaced values between them are
/// planned; sights.size() is then below `combinations`. After `stop` is requested, finishes the current plan
/// and throws Abandoned. Calls `progress`, unless it is empty, after each plan, from one thread at a time.
Survey survey(const Protocol& protocol, const rig::Rig& rig, const std::stop_token& stop = {},
              const std::function<void(int done, int of)>& progress = {});

/// Returns advice about mistakes that are likely on any rig, each at the line of its key. Examples: levels
/// smaller than the tolerance, answers that are never right, practice that is passed by always pressing the
/// same key, times in wrong units, breaks that never come, and scenes that nothing uses.
std::vector<core::Problem> advice(const Protocol& protocol);

}  // namespace turnpoint::protocol
