#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/sensing/friction_table.hpp"
#include "station/session/drift.hpp"
#include "station/session/finger_account.hpp"
#include "station/session/guidance.hpp"
#include "station/session/interludes.hpp"
#include "station/session/operator_gate.hpp"
#include "station/session/pages.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/programs.hpp"
#include "station/session/rows.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/store/session_log.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

/// Runs the blocks and trials of a session. It connects director, planner, trial machine, stage and store,
/// and owns the operator's gate. Everything happens on the thread that calls run(), except the planning of
/// the next trial.
class SessionRun {
 public:
  /// `director` must be in the state that corresponds to the log, and to `earlier`, which is empty for a new
  /// session. `programs` starts the separate programs of the session; null if it has none.
  SessionRun(const Setup& setup, trial::Director director, store::SessionLog log, const Earlier& earlier,
             std::unique_ptr<Stage> stage, FingerAccount account, SimulatedParticipant* participant,
             Display* display, Monitor* monitor, Programs* programs = nullptr);

  /// Runs until the last block has ended or somebody stops the session.
  Summary run();

 private:
  /// The state of the trial that is running.
  struct Running {
    trial::TrialSpec spec;
    /// what is presented: `spec` or, once the intervals of an adjustment are presented again, `spec` with the
    /// slider's setting
    trial::TrialSpec shown;
    trial::Machine machine;
    core::TrialRow row;
    std::optional<trial::Slider> slider;  ///< the slider of an adjustment
    std::optional<double> value;          ///< the participant's answer, if it is a number
    /// onsets of all intervals of the last presentation; set once the intervals are scheduled
    std::vector<Onset> onsets;
    std::size_t begun = 0;     ///< number of intervals whose presentation has begun, over all presentations
    std::size_t measured = 0;  ///< number of intervals for which pick-ups have reported a measurement
    /// number of intervals in the presentations before the last one, from which those of the last one count
    std::size_t first = 0;
    bool decided = false;
    bool outside = false;  ///< the finger did not move in the way that the protocol asks for
    /// True if something went wrong. A trial that is repeated because of the finger's movement is not void.
    bool is_void() const { return row.outcome == core::Outcome::fault && !outside; }
    /// True while the surface follows the slider: in the last part of the trial.
    bool is_set() const {
      return machine.phase() == trial::Phase::stimulus && begun > first && begun - first == onsets.size();
    }
    /// the boundary of the trial's last scene is where the relative friction has this value
    std::optional<double> friction_level = {};
    /// true if the answer came from a button, so that the touch panel's latency does not apply
    bool by_button = false;
    /// the plans of the intervals of the last presentation that follow the finger; empty once recorded
    FollowPlans follows = {};
    std::vector<FollowedRange> presented = {};  ///< the frames of the intervals of the last presentation
  };
  /// Times at which one interval begins and ends on the surface.
  struct OnSurface {
    std::int64_t on_ns = 0, off_ns = 0;
  };

  // Blocks and pages.
  Flow run_parts();
  Flow run_block();
  Flow leave_block();
  Flow play_example(const protocol::Example& example, Page page);
  Flow pass_self_test();
  Flow pass_mixer();
  std::string reason_despite(const std::string& stopped_by, const std::string& failed);
  Flow rest_if_due(int trials_in_block);
  int trial_index() const { return log_.session().trials; }
  void finish(core::SessionStatus status, const std::string& reason);

  // Procedures and observers that are separate programs.
  std::optional<trial::TrialSpec> next_trial();
  void plan_ahead();
  void log_programs();
  void log_estimates();

  // One trial.
  Flow run_trial(trial::TrialSpec spec);
  Flow prepare_trial(const trial::TrialSpec& spec);
  Flow keep_limits(const trial::TrialSpec& spec);
  Flow after_trial(const Running& trial);
  void check_plans(const trial::TrialSpec& spec);
  std::optional<trial::EventKind> open_amplifier();
  void drive_trial(Running& trial, std::optional<trial::EventKind> cut_by);
  void handle_in_trial(Input raw, Running& trial);
  void perform(const std::vector<trial::Action>& actions, Running& trial);
  void present(std::int64_t earliest_ns, Running& trial);
  std::optional<std::int64_t> prepare_again(std::int64_t earliest_ns, Running& trial);
  void interval_begins(Running& trial);
  void ask_observer(const Running& trial, std::int64_t onset_ns);
  void decide(Running& trial);
  void record_followed(Running& trial);
  void finish_row(Running& trial);
  void keep_raw(Running& trial);
  void leave_surface();
  void count(const trial::TrialSpec& spec, const core::TrialRow& row);

  // Trigger codes.
  void trigger(protocol::TriggerEvent event, const Running& trial);
  void trigger_intervals(const Running& trial);
  void log_triggers();
  void finish_triggers();

  // Bars that guide the finger.
  bool is_finger_watched() const;
  void move_bars();
  void hold_bars(trial::Phase phase, const Running& trial);

  // Blocks in which the finger strokes the surface and nothing is asked.
  bool is_training() const;
  void judge_strokes(const sensing::TrialForces& forces, const Input& input, Running& trial);
  Flow finish_friction_table();
  void use_measured_friction();
  sensing::FrictionTable measured_friction(int block_index) const;

  // Adjustments.
  void show_phase(trial::Phase phase, const Running& trial);
  std::optional<trial::Event> event_in_trial(const Input& input, Running& trial, bool by_button);
  void glide(Running& trial);

  const Setup& setup_;
  store::SessionLog log_;
  std::unique_ptr<Stage> stage_;
  FingerAccount account_;
  SimulatedParticipant* participant_;  ///< null if a person takes part
  Display* display_;
  Monitor* monitor_;
  Programs* programs_;
  /// why a program failed while the next trial was being planned; next_trial() deals with it
  std::optional<std::string> failed_program_;
  PlanAhead plans_;
  trial::Director director_;
  Pages pages_;
  OperatorGate gate_;
  int holds_ = 0;  ///< the holds of gate_ that next_trial() has taken into account
  Scores scores_;
  Interludes interludes_;
  Summary summary_;
  std::string known_mixer_;  ///< what the mixer's check found when the operator last went on despite it
  int examples_ = 0;         ///< examples presented so far
  int scored_ = 0, right_ = 0;
  int voids_in_a_row_ = 0, refused_in_a_row_ = 0, repeats_in_a_row_ = 0, unanswered_in_a_row_ = 0;
  std::int64_t started_ns_ = 0;
  std::vector<OnSurface> surface_;
  Drift drift_;
  Guide guide_;
  std::int64_t guide_due_ns_ = 0;
};

}  // namespace turnpoint::session
