#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "station/report/chart.hpp"
#include "station/session/along_strip.hpp"
#include "station/session/monitor.hpp"
#include "station/view/live_facts.hpp"
#include "station/view/preview.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::view {

/// A running session as the operator sees it: texts and figures, ready to be shown.
struct LiveState {
  /// number and level of the current trial
  std::string heading;
  /// facts about the scene, the session so far and the exposure limits, as pairs of a label and a value
  std::vector<std::pair<std::string, std::string>> scene, course, limits;
  /// what pick-ups and force cells measured in the last trial; empty if the rig has neither
  std::vector<std::pair<std::string, std::string>> sensors;
  /// drawings of the surface, one for each scene, in the order of presentation
  std::vector<Drawing> surfaces;
  /// figures: displacement profile of all scenes, levels, response times, and friction along the strip; each
  /// is empty if there are no data
  Drawing profile, trace, times, strip;
};

/// How long a trial's stimuli were presented, in s: their scheduled length or, if the last part is explored,
/// until the answer in it.
double stimulus_s(const core::TrialRow& row, int rate_Hz, bool explored);

/// Describes and draws a running session for the operator, on its own thread. It reports a new state whenever
/// something changes. While the participant moves a slider, it shows the newest setting five times a second.
class LiveView : public session::Monitor {
 public:
  /// Receives each new state. Called on LiveView's own thread.
  using OnState = std::function<void(LiveState)>;
  /// Receives the gauges whenever they change. Called on the session thread; must return at once.
  using OnGauges = std::function<void(FingerGauges)>;
  /// `language` is that of all texts and figures, such as "de". `stored` is counted up with each trial that
  /// is stored.
  LiveView(const protocol::Protocol& protocol, const rig::Rig& rig, OnState on_state,
           std::string language = "en", OnGauges on_gauges = {},
           std::shared_ptr<std::atomic<int>> stored = nullptr);
  ~LiveView() override;

  void trial_begins(const trial::TrialSpec& spec, const protocol::Block& block,
                    const session::PlanAhead::Plans& plans) override;
  void surface_follows(const trial::TrialSpec& spec, const scene::DrivePlan& plan) override;
  void trial_ended(const trial::TrialSpec& spec, const core::TrialRow& row) override;
  bool watches_finger() const override { return static_cast<bool>(on_gauges_); }
  void finger_moved(const std::optional<session::FingerSeen>& finger) override;

 private:
  struct Begun {
    trial::TrialSpec spec;
    std::string block;
    session::PlanAhead::Plans plans;
  };
  struct Setting {
    protocol::Factors factors;
    scene::DrivePlan plan;
  };
  struct News {
    std::optional<Begun> begun;
    std::optional<Setting> setting;
    std::optional<LiveTrial> ended;
    /// stored row of the ended trial, with its force signal
    std::shared_ptr<const core::TrialRow> row = nullptr;
  };
  void push(News news);
  void work(const std::stop_token& stop);
  void take(const News& news);
  void show();
  void tell();

  OnState on_state_;
  OnGauges on_gauges_;
  std::shared_ptr<std::atomic<int>> stored_;
  std::optional<FingerGauges> gauges_;  ///< as they were last shown; used on the session thread alone
  std::string language_;
  /// name of the factor that the first procedure varies, or "Level" if there is no procedure
  std::string level_;
  std::optional<protocol::Sensing> asked_;
  /// of each task
  struct HowAnswered {
    std::string adjusts;    ///< the factor that a slider sets; "" if there is none
    bool explored = false;  ///< whether the participant may answer while the surface moves
  };
  static std::vector<HowAnswered> how_answered(const protocol::Protocol& protocol);
  std::vector<HowAnswered> tasks_;
  rig::Rig rig_;
  // The worker thread alone uses the members from `planner_` to `state_`.
  scene::Planner planner_;
  Begun trial_;                    ///< the current trial; its scenes are those presented now
  std::optional<double> setting_;  ///< the slider's setting; empty until it has been moved
  std::chrono::steady_clock::time_point next_setting_;
  std::vector<LiveTrial> trials_;
  session::AlongStrip along_;
  std::optional<double> peak_displacement_m_;
  LiveState state_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<News> queue_;
  // Keep this member last: its destructor then joins the thread before the objects that the thread uses are
  // destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::view
