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

/// Plans trials, down to the peaks of their bursts, before they are wanted, on a thread of its own: the
/// session begins the next one as soon as the last is decided, and takes it at its start. The planner's
/// results do not depend on when it is asked, so neither do the stimuli.
class PlanAhead {
 public:
  /// For each interval of a trial the plans of its scenes, and what the drive plays: checked, with its peaks,
  /// and with start frames that count from the first interval's onset.
  using Plans = std::vector<std::vector<scene::DrivePlan>>;
  struct Planned {
    Plans plans;
    std::vector<drive::PreparedBurst> bursts;
  };

  /// The rig and the protocol must outlive it. `seed` is the session's. Throws as scene::Planner.
  PlanAhead(const rig::Rig& rig, const protocol::Protocol& protocol, std::uint64_t seed);
  ~PlanAhead();

  /// Begins a trial; one that waits and was not begun yet is dropped for it. Beginning the same again does
  /// nothing.
  void begin(const trial::TrialSpec& trial);
  /// True where take() would not wait.
  bool ready(const trial::TrialSpec& trial);
  /// The plans of a trial, waiting for them if need be. Throws what planning them threw.
  const Planned& take(const trial::TrialSpec& trial);

 private:
  void run(const std::stop_token& stop);
  Planned plan(const trial::TrialSpec& trial);
  std::vector<drive::PreparedBurst> bursts_of(const trial::TrialSpec& trial,
                                              const std::vector<std::vector<scene::DrivePlan>>& plans) const;

  const rig::Rig& rig_;
  const protocol::Protocol& protocol_;
  const std::uint64_t seed_;
  scene::Planner planner_;  // worker thread only
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<trial::TrialSpec> wanted_;  ///< newest trial asked for and not yet begun
  std::string wanted_key_, done_key_;
  Planned done_;
  std::exception_ptr failed_;
  std::jthread thread_;  // last: joined before what it uses goes
};

}  // namespace turnpoint::session
