#pragma once
// What an observer of one cue perceives in whole sessions, planned trial by trial.
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/scene/planner.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::tests {

/// The values of the eight cues in one interval, for the last and the first scene of the interval.
struct Numbers {
  std::vector<double> last, first;
};
inline const std::vector<std::string> cue_names = {
    "pitch",       "loudness", "amplitude at the wide end", "stripe pitch at the wide end", "edge sharpness",
    "strip width", "duration", "always the same key"};

struct Seen {
  std::vector<Numbers> intervals;
  int correct = 0;
};

/// Plans the scenes of trials.
class World {
 public:
  World(const protocol::Protocol& protocol, const rig::Rig& rig) : protocol_(protocol), planner_(rig) {}

  std::vector<Numbers> look(const trial::TrialSpec& trial);

 private:
  std::vector<double> numbers(const std::string& scene, const trial::TrialSpec& trial, double rove_dB);

  const protocol::Protocol& protocol_;
  scene::Planner planner_;
  std::map<std::string, std::map<protocol::Factors, std::optional<scene::Cues>>> known_;
};

/// Returns the value of a cue in an interval: in its last scene (feature 0), its change (1), or in its first
/// scene (2).
double seen_number(const Numbers& numbers, std::size_t cue, int feature);
std::vector<double> seen_numbers(const std::vector<Numbers>& intervals, std::size_t cue, int feature);

/// Simulates a session, in which practice is always passed.
void run_session(const protocol::Protocol& protocol, std::uint64_t seed,
                 const std::function<std::optional<int>(const trial::TrialSpec&)>& answer);

/// True if a procedure of this kind chooses levels by the answers.
bool sets_levels(const procedure::Spec& spec);

/// Collects what an observer can perceive in whole sessions. If a procedure chooses levels by the answers, a
/// random level that it can present is used instead.
std::vector<Seen> watch(const protocol::Protocol& protocol, World& world);

}  // namespace turnpoint::tests
