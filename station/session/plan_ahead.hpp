#pragma once
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Plans trials in advance on its own thread, including the peaks of their bursts. The session starts
/// planning the next trial as soon as the last one is decided, and takes the result at its start. The
/// planner's results do not depend on when it is called, so neither do the stimuli.
class PlanAhead {
 public:
  /// For each interval of a trial: the plans of its scenes, and the checked burst with its peaks. Start
  /// frames count from the first interval's onset.
  using Plans = std::vector<std::vector<scene::DrivePlan>>;
  struct Planned {
    Plans plans;
    std::vector<drive::PreparedBurst> bursts;
  };

  /// The rig and the protocol must outlive this object. `seed` is the seed of the session. Throws the errors
  /// of scene::Planner.
  PlanAhead(const rig::Rig& rig, const protocol::Protocol& protocol, std::uint64_t seed);
  ~PlanAhead();

  /// Starts planning a trial. An earlier trial that is still waiting is dropped. Starting the same trial
  /// again has no effect.
  void begin(const trial::TrialSpec& trial);
  /// True if take() would not have to wait.
  bool ready(const trial::TrialSpec& trial);
  /// The plans of a trial; waits for them if necessary. If planning failed, throws its exception.
  const Planned& take(const trial::TrialSpec& trial);

 private:
  void run(const std::stop_token& stop);
  Planned plan(const trial::TrialSpec& trial);
  std::vector<drive::PreparedBurst> bursts_of(const trial::TrialSpec& trial,
                                              const std::vector<std::vector<scene::DrivePlan>>& plans) const;

  const rig::Rig& rig_;
  const protocol::Protocol& protocol_;
  const std::uint64_t seed_;
  scene::Planner planner_;  // used by the worker thread only
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<trial::TrialSpec> wanted_;  ///< the newest requested trial whose planning has not begun
  std::string wanted_key_, done_key_;
  Planned done_;
  std::exception_ptr failed_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::session
