#pragma once
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "station/audio/prepared_burst.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"
#include "station/sensing/friction_table.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Plans trials in advance on its own thread, including the peaks of their bursts. The session requests the
/// plan of the next trial as soon as the previous trial is decided, and takes it when the trial starts. Plans
/// do not depend on when they are computed, so stimuli do not depend on timing.
class PlanAhead {
 public:
  /// For each part of a trial (trial::parts_of): the plans of its scenes, and the checked burst with its
  /// peaks. The start frames of bursts count from the first part's onset.
  using Plans = std::vector<std::vector<scene::DrivePlan>>;
  struct Planned {
    Plans plans;
    std::vector<audio::PreparedBurst> bursts;
  };

  /// The protocol must outlive this object. `seed` is the seed of the session. Throws the errors
  /// of scene::Planner.
  PlanAhead(const rig::Rig& rig, const protocol::Protocol& protocol, std::uint64_t seed);
  ~PlanAhead();

  /// Uses this friction table instead of the rig's for all trials planned from now on.
  void use_friction(const sensing::FrictionTable& table);

  /// Starts planning a trial. If an earlier trial is still waiting to be planned, it is dropped. Starting the
  /// same trial again has no effect.
  void begin(const trial::TrialSpec& trial);
  /// True if take() would return at once.
  bool ready(const trial::TrialSpec& trial);
  /// Returns the plans of a trial, and waits for them if necessary. If planning failed, throws the planner's
  /// exception.
  const Planned& take(const trial::TrialSpec& trial);

  /// Call this when the resonance frequencies of the surface have risen by the fraction `share`. All
  /// frequencies are then multiplied by 1 + share, so that boundaries stay where they were planned. Plans
  /// that were made before are made again.
  void set_drift(double share);

 private:
  /// What a plan depends on.
  struct Request {
    trial::TrialSpec trial;
    double drift = 0;
    bool operator==(const Request&) const = default;
  };

  void run(const std::stop_token& stop);
  Planned plan(const trial::TrialSpec& trial, double drift);
  scene::DrivePlan plan_strokes(const trial::TrialSpec& trial);
  std::vector<audio::PreparedBurst> bursts_of(const trial::TrialSpec& trial,
                                              const std::vector<std::vector<scene::DrivePlan>>& plans) const;

  rig::Rig rig_;
  const protocol::Protocol& protocol_;
  const std::uint64_t seed_;
  scene::Planner planner_;  // only the worker thread uses it, while it plans
  std::mutex mutex_;
  std::condition_variable_any changed_;
  double drift_ = 0;
  std::optional<Request> wanted_;    ///< the newest request
  bool waiting_ = false;             ///< its planning has not begun
  bool planning_ = false;            ///< the thread is planning
  std::optional<Request> done_for_;  ///< the request to which `done_` and `failed_` belong
  Planned done_;
  std::exception_ptr failed_;
  // Keep this member last: its destructor then joins the thread before the objects that the thread uses are
  // destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::session
