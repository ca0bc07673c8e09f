#include "station/view/live_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "station/core/number.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"
#include "station/report/figures.hpp"
#include "station/report/words.hpp"
#include "station/view/report_data.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::view {

namespace {

using core::number;
using report::Words;

/// Each setting of a slider is displayed for at least this time, so that the operator can read it.
constexpr std::chrono::milliseconds kSettingEvery{200};

std::string in_words(const trial::TrialSpec& spec) {
  std::string order;
  for (const auto& interval : spec.intervals) {
    std::string scenes;
    for (const auto& scene : interval) scenes += (scenes.empty() ? "" : " \u2192 ") + scene;
    order += (order.empty() ? "" : " | ") + scenes;
  }
  return order;
}

}  // namespace

double stimulus_s(const core::TrialRow& row, int rate_Hz, bool explored) {
  double scheduled_s = 0, last_s = 0, first_scene_s = 0;
  int last = 0;
  for (const auto& tone : row.tones) last = std::max(last, tone.interval_index);
  for (const auto& tone : row.tones) {
    if (tone.tone_index != 0) continue;
    const double length_s = static_cast<double>(tone.length_frames) / rate_Hz;
    scheduled_s += length_s;
    if (tone.interval_index == last) last_s += length_s;
    if (tone.interval_index == last && tone.scene_index == 0) first_scene_s = length_s;
  }
  const bool at_change = row.timing.response_zero == "change";
  if (!explored || !row.timing.response_time_s || (!at_change && row.timing.response_zero != "go_cue"))
    return scheduled_s;
  const double until_answer_s = *row.timing.response_time_s + (at_change ? first_scene_s : 0);
  return scheduled_s - last_s + std::min(last_s, until_answer_s);
}

std::vector<LiveView::HowAnswered> LiveView::how_answered(const protocol::Protocol& protocol) {
  std::vector<HowAnswered> tasks;
  for (const auto* one : protocol::tasks_of(protocol))
    tasks.push_back({one->task.adjusts, protocol::explored(one->task)});
  return tasks;
}

LiveView::LiveView(const protocol::Protocol& protocol, const rig::Rig& rig, OnState on_state,
                   std::string language, OnGauges on_gauges, std::shared_ptr<std::atomic<int>> stored)
    : on_state_(std::move(on_state)),
      on_gauges_(std::move(on_gauges)),
      stored_(std::move(stored)),
      language_(std::move(language)),
      level_(protocol::common_level(protocol).value_or(Words(language_)("figure.level"))),
      asked_(protocol.sensing),
      tasks_(how_answered(protocol)),
      rig_(rig),
      planner_(rig_),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

LiveView::~LiveView() = default;

void LiveView::trial_begins(const trial::TrialSpec& spec, const protocol::Block& block,
                            const session::PlanAhead::Plans& plans) {
  push({Begun{spec, block.name, plans}, {}, {}});
}

void LiveView::surface_follows(const trial::TrialSpec& spec, const scene::DrivePlan& plan) {
  push({{}, Setting{spec.factors, plan}, {}});
}

void LiveView::finger_moved(const std::optional<session::FingerSeen>& finger) {
  const auto gauges = finger_gauges(finger, asked_, rig_);
  if (!on_gauges_ || gauges_ == gauges) return;
  gauges_ = gauges;
  on_gauges_(gauges);
}

void LiveView::trial_ended(const trial::TrialSpec& spec, const core::TrialRow& row) {
  if (stored_) ++*stored_;
  LiveTrial trial{row, stimulus_s(row, rig_.output.rate_Hz, tasks_.at(spec.task).explored)};
  trial.tones.clear();
  trial.signal_rows.clear();
  push({{}, {}, std::move(trial), std::make_shared<core::TrialRow>(row)});
}

void LiveView::push(News news) {
  {
    const std::lock_guard lock(mutex_);
    if (news.setting && !queue_.empty() && queue_.back().setting)
      queue_.pop_back();  // a newer setting replaces one that was not shown yet
    queue_.push_back(std::move(news));
  }
  arrived_.notify_one();
}

void LiveView::work(const std::stop_token& stop) {
  for (;;) {
    News news;
    {
      std::unique_lock lock(mutex_);
      if (!arrived_.wait(lock, stop, [this] { return !queue_.empty(); })) return;
      arrived_.wait_until(lock, stop, next_setting_,
                          [this] { return !queue_.front().setting || queue_.size() > 1; });
      news = std::move(queue_.front());
      queue_.pop_front();
    }
    take(news);
    tell();
  }
}

void LiveView::take(const News& news) {
  if (news.begun) {
    trial_ = *news.begun;
    setting_.reset();
    show();
  }
  if (news.setting) {
    next_setting_ = std::chrono::steady_clock::now() + kSettingEvery;
    trial_.spec.factors = news.setting->factors;
    trial_.plans.front().back() = news.setting->plan;
    setting_ = std::get<double>(trial_.spec.factors.at(tasks_.at(trial_.spec.task).adjusts));
    show();
  }
  if (!news.ended) return;
  trials_.push_back(*news.ended);
  const auto trace = live_trace(trials_, level_, language_);
  const auto times = live_times(trials_, language_);
  state_.trace = trace ? drawing_of(*trace) : Drawing();
  state_.times = times ? drawing_of(*times) : Drawing();
  state_.sensors = sensors_of(*news.row, asked_, language_);
  if (news.row->type == core::TrialType::practice || news.row->outcome != core::Outcome::answered) return;
  for (const auto& signal : news.row->signal_rows)
    if (signal.stream == "finger") along_.add(*news.row, signal, rig_.output.rate_Hz);
  const auto strip = report::strip_chart(curves_of(along_), language_);
  state_.strip = strip ? drawing_of(alone("Friction along the strip", *strip)) : Drawing();
}

void LiveView::show() {
  const auto& spec = trial_.spec;
  const Words words(language_);
  const auto level = spec.level ? words("live.at_level", number(*spec.level, 4)) : std::string();
  const auto now = setting_ ? words("live.now_level", number(*setting_, 4)) : std::string();
  state_.heading = words(
      "live.heading", {trial_.block, std::to_string(spec.trial_in_block + 1), level + now, in_words(spec)});
  state_.scene.clear();
  state_.surfaces.clear();
  peak_displacement_m_.reset();
  std::vector<SceneLook> looks;
  for (const auto& interval : trial_.plans)
    for (const auto& plan : interval) looks.push_back(look_at(plan, spec.factors, planner_));
  for (const auto& look : looks) {
    if (looks.size() > 1)
      state_.scene.emplace_back(words("design.keys.scene"),
                                fmt::format("{} {}", state_.surfaces.size() + 1, look.scene));
    for (const auto& [label, value] : look.facts) state_.scene.emplace_back(words(label), words(value));
    state_.surfaces.push_back(drawing_of_surface(look, rig_, language_));
    peak_displacement_m_ = std::max(peak_displacement_m_.value_or(0), look.plan.peak_displacement_m);
  }
  state_.profile = drawing_of(profile_figure(looks, language_));
}

void LiveView::tell() {
  state_.course = course_of(trials_, language_);
  state_.limits = limits_used(trials_, peak_displacement_m_, rig_, language_);
  on_state_(state_);
}

}  // namespace turnpoint::view
