#pragma once
#include <memory>
#include <optional>

#include "station/scene/planner.hpp"
#include "station/session/director.hpp"
#include "station/session/pages.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/store/session_log.hpp"
#include "station/trial/trial.hpp"

namespace turnpoint::session {

/// One sitting while it runs: joins director, planner, trial machine, stage, display and store. Everything
/// happens on the thread that calls run().
class Sitting {
 public:
  Sitting(const Setup& setup, std::uint64_t seed, store::SessionLog log, std::unique_ptr<Stage> stage,
          Display* display, Monitor* monitor);

  /// To the end of the last block, or until somebody stops it.
  Summary run();

 private:
  enum class Flow { go_on, stop };

  Flow run_block();
  Flow run_trial(const TrialSpec& spec);
  void drive_trial(const TrialSpec& spec, trial::Machine& machine, store::TrialRow& row);
  void perform(const std::vector<trial::Action>& actions, const TrialSpec& spec, trial::Machine& machine,
               store::TrialRow& row);
  void present(int interval, std::int64_t earliest_ns, const TrialSpec& spec, trial::Machine& machine,
               store::TrialRow& row);
  void finish_row(const TrialSpec& spec, const trial::Machine& machine, store::TrialRow& row);
  void count(const TrialSpec& spec, const store::TrialRow& row);
  void replay_stored_blocks();
  void enter_stored(const store::BlockStart& block);
  Flow show_and_wait(Page page, double at_least_s);
  Flow rest_if_due(int trials_in_block);
  void show(const Page& page);
  void note(const Input& input);
  void finish(store::SessionStatus status, const std::string& reason);

  const Setup& setup_;
  store::SessionLog log_;
  std::unique_ptr<Stage> stage_;
  Display* display_;
  Monitor* monitor_;
  scene::Planner planner_;
  Director director_;
  Pages pages_;
  Summary summary_;
  int trial_index_ = 0;
  int scored_ = 0, right_ = 0;
  int voids_in_a_row_ = 0;
  std::int64_t started_ns_ = 0;
  bool stop_asked_ = false, pause_asked_ = false;
  std::string stop_reason_;
  FaultKind fault_ = FaultKind::other;
};

}  // namespace turnpoint::session
