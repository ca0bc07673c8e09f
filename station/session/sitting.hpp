#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "station/session/director.hpp"
#include "station/session/finger_account.hpp"
#include "station/session/pages.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/store/session_log.hpp"
#include "station/trial/trial.hpp"

namespace turnpoint::session {

/// One sitting while it runs: joins director, planner, trial machine, stage, display and store. Everything
/// happens on the thread that calls run(), but for the planning of the next trial.
class Sitting {
 public:
  /// `director` stands where the log does.
  Sitting(const Setup& setup, Director director, store::SessionLog log, std::unique_ptr<Stage> stage,
          FingerAccount account, Display* display, Monitor* monitor);

  /// To the end of the last block, or until somebody stops it.
  Summary run();

 private:
  enum class Flow { go_on, stop };

  /// A trial while it runs.
  struct Running {
    TrialSpec spec;
    trial::Machine machine;
    store::TrialRow row;
    std::optional<Slider> slider;  ///< in an adjustment
    std::vector<Onset> onsets;     ///< of all intervals, once they are scheduled
    std::size_t begun = 0;         ///< of them, so far
    bool decided = false;
    bool by_button = false;  ///< answered so: the touch panel's latency is not in it
  };
  /// An interval of the trial, as it is scheduled, on the surface, or was.
  struct OnSurface {
    std::int64_t on_ns = 0, off_ns = 0;
  };

  // sitting.cpp: blocks and pages
  Flow run_block();
  Flow show_and_wait(Page page, double at_least_s);
  Flow rest_if_due(int trials_in_block);
  Flow handle_on_page(const Input& input);
  void show(const Page& page);
  void finish(store::SessionStatus status, const std::string& reason);

  // sitting_trial.cpp: one trial
  Flow run_trial(const TrialSpec& spec);
  Flow prepare_trial(const TrialSpec& spec);
  Flow keep_limits(const TrialSpec& spec);
  Flow after_trial(const store::TrialRow& row);
  void check_plans(const TrialSpec& spec);
  std::optional<trial::EventKind> open_amplifier();
  void drive_trial(Running& trial, std::optional<trial::EventKind> cut_by);
  void handle_in_trial(Input raw, Running& trial);
  void perform(const std::vector<trial::Action>& actions, Running& trial);
  void present(std::int64_t earliest_ns, Running& trial);
  void interval_begins(Running& trial);
  void ask_observer(const Running& trial, std::int64_t onset_ns);
  void decide(Running& trial);
  void finish_row(Running& trial);
  void leave_surface();
  void count(const TrialSpec& spec, const store::TrialRow& row);

  // sitting_adjustment.cpp
  void show_phase(trial::Phase phase, const Running& trial);
  std::optional<trial::Event> event_in_trial(const Input& input, Running& trial);
  void glide(Running& trial);

  // sitting_operator.cpp: inputs, amplifier, faults
  Input received(Input input);
  void note(const Input& input);
  void log(const Input& input);
  void keep(const std::function<void()>& write);
  bool space_again(const std::string& detail);
  bool armed() const;
  Flow until_armed(const Fault& why);
  Flow end_at_limit(const std::string& what);
  Flow recover();

  const Setup& setup_;
  store::SessionLog log_;
  std::unique_ptr<Stage> stage_;
  FingerAccount account_;
  Display* display_;
  Monitor* monitor_;
  PlanAhead plans_;
  Director director_;
  Pages pages_;
  Summary summary_;
  int trial_index_ = 0;
  int scored_ = 0, right_ = 0;
  int voids_in_a_row_ = 0;
  std::int64_t started_ns_ = 0;
  std::vector<OnSurface> surface_;
  bool stop_asked_ = false, pause_asked_ = false;
  std::string stop_reason_;
  std::optional<Fault> fault_;  ///< what happened and nobody has dealt with yet
};

}  // namespace turnpoint::session
