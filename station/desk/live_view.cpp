#include "station/desk/live_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "station/desk/report_data.hpp"
#include "station/desk/scene_figures.hpp"
#include "station/report/figures.hpp"
#include "station/session/rows.hpp"
#include "station/text/number.hpp"

namespace turnpoint::desk {

namespace {

using text::number;
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Time over which the duty cycle is computed: the limit applies to every period of 60 s.
constexpr double kWindow_s = 60;

/// Each setting of a slider is displayed for at least this time, so that the operator can read it.
constexpr std::chrono::milliseconds kSettingEvery{200};

std::string percent(double share) { return number(std::round(1000 * share) / 10, 4) + " %"; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

int count(const std::vector<LiveTrial>& trials, terms::Outcome outcome) {
  return static_cast<int>(std::count_if(trials.begin(), trials.end(),
                                        [&](const LiveTrial& trial) { return trial.outcome == outcome; }));
}

std::string in_words(const trial::TrialSpec& spec) {
  std::string order;
  for (const auto& interval : spec.intervals) {
    std::string scenes;
    for (const auto& scene : interval) scenes += (scenes.empty() ? "" : " then ") + scene;
    order += (order.empty() ? "" : " | ") + scenes;
  }
  return order;
}

plot::Figure alone(const char* title, const plot::Chart& panel) {
  plot::Figure figure;
  figure.title = title;
  figure.charts = {panel};
  figure.chart_width_px = 430, figure.chart_height_px = 230;
  return figure;
}

/// Returns how long the stimulus was presented: its scheduled duration or, for an exploration, the time until
/// the answer.
double stimulus_s(const records::TrialRow& row, int rate_Hz) {
  double scheduled_s = 0;
  int intervals = 1;
  for (const auto& tone : row.tones) {
    if (tone.tone_index == 0) scheduled_s += static_cast<double>(tone.length_frames) / rate_Hz;
    intervals = std::max(intervals, tone.interval_index + 1);
  }
  return intervals == 1 && row.response_time_s ? std::min(scheduled_s, *row.response_time_s) : scheduled_s;
}

}  // namespace

namespace {

std::string vibration(const LiveTrial& trial) {
  const bool measured = trial.proof != records::Proof::unproven;
  return records::name(trial.proof) + (measured ? ": " + trial.measured : std::string());
}

/// Adds the latest estimate of each procedure that has one, with its 95 % interval.
void add_estimates(const std::vector<LiveTrial>& trials, Facts& facts) {
  std::map<std::string, const LiveTrial*> latest;
  for (const auto& trial : trials)
    if (trial.threshold_est && std::isfinite(*trial.threshold_est)) latest[trial.procedure] = &trial;
  for (const auto& [procedure, trial] : latest) {
    auto value = number(*trial->threshold_est, 3);
    if (trial->threshold_sd && std::isfinite(*trial->threshold_sd)) {
      const double half = 1.96 * *trial->threshold_sd;
      value += fmt::format(" (95 %: {} to {})", number(*trial->threshold_est - half, 3),
                           number(*trial->threshold_est + half, 3));
    }
    facts.emplace_back("Estimate, " + procedure, value);
  }
}

}  // namespace

Facts course_of(const std::vector<LiveTrial>& trials) {
  using terms::Outcome;
  std::vector<double> times;
  int scored = 0, right = 0, catches = 0, caught = 0, xruns = 0, extra = 0;
  for (const auto& trial : trials) {
    xruns += trial.xruns, extra += trial.extra_touches;
    if (trial.response_time_s) times.push_back(*trial.response_time_s);
    if (!trial.correct) continue;
    if (trial.type == terms::TrialType::catch_trial) ++catches, caught += *trial.correct ? 1 : 0;
    if (trial.type == terms::TrialType::experimental) ++scored, right += *trial.correct ? 1 : 0;
  }
  Facts facts{{"Trials", std::to_string(trials.size())}};
  facts.emplace_back("Right", scored > 0 ? fmt::format("{} of {} ({})", right, scored,
                                                       percent(static_cast<double>(right) / scored))
                                         : "none scored yet");
  if (catches > 0) facts.emplace_back("Catch trials right", fmt::format("{} of {}", caught, catches));
  add_estimates(trials, facts);
  facts.emplace_back("Response time", times.empty() ? "none yet"
                                                    : "median " + number(median(times), 3) + " s, last " +
                                                          number(times.back(), 3) + " s");
  facts.emplace_back("Too late, too early", fmt::format("{}, {}", count(trials, Outcome::timeout),
                                                        count(trials, Outcome::anticipation)));
  facts.emplace_back("Void", std::to_string(count(trials, Outcome::fault) + count(trials, Outcome::aborted)));
  if (!trials.empty()) facts.emplace_back("Vibration, last trial", vibration(trials.back()));
  facts.emplace_back("Xruns", std::to_string(xruns));
  facts.emplace_back("Touches that were not answers", std::to_string(extra));
  return facts;
}

Facts limits_used(const std::vector<LiveTrial>& trials, std::optional<double> peak_displacement_m,
                  const rig::Rig& rig) {
  const auto& limits = rig.limits;
  Facts facts;
  if (peak_displacement_m)
    facts.emplace_back("Displacement",
                       fmt::format("{} of {} \u00b5m ({})", number(1e6 * *peak_displacement_m, 3),
                                   number(1e6 * limits.displacement_m, 3),
                                   percent(*peak_displacement_m / limits.displacement_m)));
  const double now_s = trials.empty() ? 0 : trials.back().ended_s;
  double on_s = 0;
  for (const auto& trial : trials) {
    const double from = std::max(trial.onset_s, now_s - kWindow_s);
    on_s += std::max(0.0, trial.onset_s + trial.stimulus_s - from);
  }
  const double window_s = std::clamp(now_s, 1.0, kWindow_s);
  facts.emplace_back("Stimulus time, last minute",
                     percent(on_s / window_s) + " (limit " + percent(limits.duty) + ")");
  facts.emplace_back("Session",
                     fmt::format("{} of {} min", number(now_s / 60, 3), number(limits.session_minutes, 3)));
  return facts;
}

Facts sensors_of(const records::TrialRow& row, const std::optional<protocol::Sensing>& asked) {
  Facts facts;
  const auto& finger = row.finger;
  const auto range = [](const std::optional<std::pair<double, double>>& wanted, const char* unit) {
    return wanted ? fmt::format(" (asked for {} to {} {})", number(wanted->first, 3),
                                number(wanted->second, 3), unit)
                  : std::string();
  };
  const auto share = [](const std::optional<double>& inside) {
    return inside ? ", " + percent(*inside) + " of the time in range" : std::string();
  };
  if (!finger.sensing.empty()) facts.emplace_back("Finger", finger.sensing);
  if (finger.normal_N)
    facts.emplace_back(
        "Normal force",
        fmt::format("{} N, SD {}{}{}", number(*finger.normal_N, 3), number(finger.normal_sd_N.value_or(0), 2),
                    range(asked ? asked->normal_N : std::nullopt, "N"), share(finger.normal_in_window)));
  if (finger.speed_mm_s)
    facts.emplace_back("Speed", fmt::format("{} mm/s{}{}", number(*finger.speed_mm_s, 3),
                                            range(asked ? asked->speed_mm_s : std::nullopt, "mm/s"),
                                            share(finger.speed_in_window)));
  if (finger.strokes) facts.emplace_back("Strokes", std::to_string(*finger.strokes));
  if (finger.mu) facts.emplace_back("Friction", number(*finger.mu, 3));
  if (finger.tare_mN)
    facts.emplace_back("Zero of the cells",
                       "moved " + number(*finger.tare_mN, 2) + " mN (flag at 5, stop at 20)");
  if (row.drive_ratio_dB)
    facts.emplace_back("Pick-up, level",
                       fmt::format("{:+.2f} dB of the plan (flag at 0.5, void at 1)", *row.drive_ratio_dB));
  if (row.drive_residual_dB)
    facts.emplace_back("Pick-up, residual",
                       fmt::format("{:.0f} dB (flag at -40, void at -30)", *row.drive_residual_dB));
  if (row.onset_error_us)
    facts.emplace_back("Pick-up, onset",
                       fmt::format("{:+.0f} us (flag at 200, void at 1000)", *row.onset_error_us));
  return facts;
}

std::optional<plot::Figure> live_trace(const std::vector<LiveTrial>& trials, const std::string& label) {
  std::map<std::string, plot::Points> series;
  std::map<std::string, plot::Line> estimates;
  std::vector<double> levels;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto& trial = trials[i];
    if (!trial.level || trial.procedure.empty()) continue;
    auto& points = series[trial.procedure];
    points.x.push_back(static_cast<double>(i + 1));
    points.y.push_back(*trial.level);
    points.open.push_back(!trial.correct.value_or(false));
    levels.push_back(*trial.level);
    if (!trial.threshold_est || !std::isfinite(*trial.threshold_est)) continue;
    estimates[trial.procedure].x.push_back(static_cast<double>(i + 1));
    estimates[trial.procedure].y.push_back(*trial.threshold_est);
  }
  if (levels.empty()) return std::nullopt;
  plot::Chart panel;
  panel.title = "Levels (open symbols: not right)";
  panel.x = {"Trial", 0, std::max(10.0, static_cast<double>(trials.size()) + 1), plot::AxisScale::linear,
             true};
  panel.y = plot::fitted(label, levels, 0.1);
  int number = 0;
  for (auto& [name, points] : series) {
    auto line = estimates[name];
    line.series = points.series = number++;
    points.name = series.size() > 1 ? name : "";
    if (line.x.size() > 1) panel.layers.push_back(line);
    panel.layers.push_back(points);
  }
  return alone("Levels", panel);
}

std::optional<plot::Figure> live_times(const std::vector<LiveTrial>& trials) {
  plot::Points points;
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (trials[i].response_time_s) {
      points.x.push_back(static_cast<double>(i + 1));
      points.y.push_back(*trials[i].response_time_s);
      points.open.push_back(!trials[i].correct.value_or(true));
    }
  if (points.x.empty()) return std::nullopt;
  plot::Chart panel;
  panel.title = "Response times (open symbols: wrong)";
  panel.x = {"Trial", 0, std::max(10.0, static_cast<double>(trials.size()) + 1), plot::AxisScale::linear,
             true};
  panel.y = plot::fitted("Response time (s)", points.y, 0.15);
  panel.y.low = 0;
  points.series = 2;
  panel.layers.push_back(points);
  return alone("Response times", panel);
}

LiveView::LiveView(const protocol::Protocol& protocol, const rig::Rig& rig, OnState on_state,
                   OnGauges on_gauges)
    : on_state_(std::move(on_state)),
      on_gauges_(std::move(on_gauges)),
      level_(protocol.procedures.empty() ? "Level" : protocol.procedures.front().level),
      asked_(protocol.sensing),
      adjusted_(protocol.task.adjusts),
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

void LiveView::trial_ended(const trial::TrialSpec& spec, const records::TrialRow& row) {
  LiveTrial trial;
  trial.procedure = spec.procedure;
  trial.level = row.level;
  trial.correct = row.correct;
  trial.response_time_s = row.response_time_s;
  trial.threshold_est = row.threshold_est;
  trial.threshold_sd = row.threshold_sd;
  trial.outcome = row.outcome;
  trial.type = row.type;
  trial.onset_s = row.onset_s;
  trial.ended_s = row.onset_s + row.duration_s;
  trial.stimulus_s = stimulus_s(row, rig_.output.rate_Hz);
  trial.xruns = row.xruns;
  trial.extra_touches = row.extra_touches;
  trial.proof = row.proof;
  trial.measured = session::describe_proof(row);
  push({{}, {}, trial, std::make_shared<records::TrialRow>(row)});
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
    setting_ = std::get<double>(trial_.spec.factors.at(adjusted_));
    show();
  }
  if (!news.ended) return;
  trials_.push_back(*news.ended);
  const auto trace = live_trace(trials_, level_);
  const auto times = live_times(trials_);
  state_.trace = trace ? drawing_of(*trace) : Drawing();
  state_.times = times ? drawing_of(*times) : Drawing();
  state_.sensors = sensors_of(*news.row, asked_);
  if (news.row->type == terms::TrialType::practice || news.row->outcome != terms::Outcome::answered) return;
  for (const auto& signal : news.row->signal_rows)
    if (signal.stream == "finger") along_.add(*news.row, signal, rig_.output.rate_Hz);
  const auto strip = report::strip_chart(curves_of(along_));
  state_.strip = strip ? drawing_of(alone("Friction along the strip", *strip)) : Drawing();
}

void LiveView::show() {
  const auto& spec = trial_.spec;
  state_.heading = fmt::format("Block {}, trial {}{}{}: {}", trial_.block, spec.trial_in_block + 1,
                               spec.level ? ", level " + number(*spec.level, 4) : "",
                               setting_ ? ", now " + number(*setting_, 4) : "", in_words(spec));
  state_.scene.clear();
  state_.surfaces.clear();
  peak_displacement_m_.reset();
  std::vector<SceneLook> looks;
  for (const auto& interval : trial_.plans)
    for (const auto& plan : interval) looks.push_back(look_at(plan, spec.factors, planner_));
  for (const auto& look : looks) {
    if (looks.size() > 1)
      state_.scene.emplace_back("Scene", fmt::format("{} {}", state_.surfaces.size() + 1, look.scene));
    state_.scene.insert(state_.scene.end(), look.facts.begin(), look.facts.end());
    state_.surfaces.push_back(drawing_of_surface(look, rig_));
    peak_displacement_m_ = std::max(peak_displacement_m_.value_or(0), look.plan.peak_displacement_m);
  }
  state_.profile = drawing_of(profile_figure(looks));
}

void LiveView::tell() {
  state_.course = course_of(trials_);
  state_.limits = limits_used(trials_, peak_displacement_m_, rig_);
  on_state_(state_);
}

}  // namespace turnpoint::desk
