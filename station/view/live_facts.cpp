#include "station/view/live_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "station/core/median.hpp"
#include "station/core/number.hpp"
#include "station/report/words.hpp"

namespace turnpoint::view {
namespace {

using Range = std::optional<std::pair<double, double>>;

constexpr double kForce_N = 2, kSpeed_mm_s = 200;  // ends of the scales if the protocol asks for nothing

Gauge gauge(std::optional<double> value, const Range& asked, double full_scale, std::string figure) {
  if (asked) full_scale = 1.5 * asked->second;
  Gauge made;
  if (asked) made.low = asked->first / full_scale, made.high = asked->second / full_scale;
  if (!value || !std::isfinite(*value)) return made;
  made.value = std::clamp(std::round(100 * *value / full_scale) / 100, 0.0, 1.0);
  made.figure = std::move(figure);
  return made;
}

}  // namespace

FingerGauges finger_gauges(const std::optional<session::FingerSeen>& finger,
                           const std::optional<protocol::Sensing>& asked, const rig::Rig& rig) {
  const auto force = asked ? asked->normal_N : Range{}, speed = asked ? asked->speed_mm_s : Range{};
  std::optional<double> normal_N, speed_mm_s, position_mm;
  if (finger) {
    normal_N = finger->normal_N;
    speed_mm_s = std::abs(finger->speed_mm_s);
    position_mm = finger->position_mm;
  }
  const double length_mm = 1e3 * rig.surface.length_m;
  return {gauge(normal_N, force, kForce_N, fmt::format("{:.2f} N", normal_N.value_or(0))),
          gauge(speed_mm_s, speed, kSpeed_mm_s, fmt::format("{:.0f} mm/s", speed_mm_s.value_or(0))),
          gauge(position_mm, {}, length_mm, fmt::format("{:.0f} mm", position_mm.value_or(0)))};
}

namespace {

using core::number;
using report::Words;
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Time over which the duty cycle is computed: the limit applies to every period of 60 s.
constexpr double kWindow_s = 60;

std::string percent(double share) { return number(std::round(1000 * share) / 10, 4) + " %"; }

int count(const std::vector<LiveTrial>& trials, core::Outcome outcome) {
  return static_cast<int>(std::count_if(trials.begin(), trials.end(),
                                        [&](const LiveTrial& trial) { return trial.outcome == outcome; }));
}

// In the order of core::Proof.
constexpr const char* kProofs[] = {"proof.unproven", "proof.ok",      "proof.flagged",
                                   "proof.refused",  "proof.stopped", "proof.lost"};
static_assert(std::size(kProofs) == core::proofs.size());

std::string vibration(const core::SurfaceRow& surface, const Words& words) {
  std::string said = words(kProofs[static_cast<std::size_t>(surface.proof)]);
  if (surface.proof_cause != core::ProofCause::none)
    said += "; " + words(core::phrase_of(surface.proof_cause));
  return said;
}

/// Adds the latest estimate of each procedure that has one, with its 95 % interval.
void add_estimates(const std::vector<LiveTrial>& trials, const Words& words, Facts& facts) {
  std::map<std::string, const LiveTrial*> latest;
  for (const auto& trial : trials)
    if (trial.learned.threshold_est && std::isfinite(*trial.learned.threshold_est))
      latest[trial.procedure] = &trial;
  for (const auto& [procedure, trial] : latest) {
    auto value = number(*trial->learned.threshold_est, 3);
    if (trial->learned.threshold_sd && std::isfinite(*trial->learned.threshold_sd)) {
      const double half = 1.96 * *trial->learned.threshold_sd;
      value = words("live.interval", {value, number(*trial->learned.threshold_est - half, 3),
                                      number(*trial->learned.threshold_est + half, 3)});
    }
    facts.emplace_back(words("live.estimate", procedure), value);
  }
}

/// Adds what the pick-ups measured in a trial, with the limits from which it is flagged or void.
void add_pick_ups(const core::SurfaceRow& surface, const Words& words, Facts& facts) {
  if (surface.drive_ratio_dB)
    facts.emplace_back(words("live.pick_up_level"),
                       words("live.pick_up_level_value", fmt::format("{:+.2f}", *surface.drive_ratio_dB)));
  if (surface.drive_residual_dB)
    facts.emplace_back(
        words("live.pick_up_residual"),
        words("live.pick_up_residual_value", fmt::format("{:.0f}", *surface.drive_residual_dB)));
  if (surface.onset_error_us)
    facts.emplace_back(words("live.pick_up_onset"),
                       words("live.pick_up_onset_value", fmt::format("{:+.0f}", *surface.onset_error_us)));
}

}  // namespace

report::Figure alone(const char* title, const report::Chart& panel) {
  report::Figure figure;
  figure.title = title;
  figure.charts = {panel};
  figure.chart_width_px = 430, figure.chart_height_px = 230;
  return figure;
}

Facts course_of(const std::vector<LiveTrial>& trials, const std::string& language) {
  const Words words(language);
  using core::Outcome;
  std::vector<double> times;
  int scored = 0, right = 0, catches = 0, caught = 0, xruns = 0, extra = 0;
  for (const auto& trial : trials) {
    xruns += trial.presented.xruns, extra += trial.given.extra_touches;
    if (trial.timing.response_time_s) times.push_back(*trial.timing.response_time_s);
    const bool missed = trial.outcome == Outcome::timeout || trial.outcome == Outcome::anticipation;
    if (trial.type == core::TrialType::catch_trial && (missed || trial.given.correct))
      ++catches, caught += trial.given.correct.value_or(false) ? 1 : 0;
    if (!trial.given.correct) continue;
    if (trial.type == core::TrialType::experimental) ++scored, right += *trial.given.correct ? 1 : 0;
  }
  const auto whole = [](auto value) { return std::to_string(value); };
  Facts facts{{words("operator.trials"), whole(trials.size())}};
  facts.emplace_back(words("report.right"),
                     scored > 0 ? words("live.of_share", {whole(right), whole(scored),
                                                          percent(static_cast<double>(right) / scored)})
                                : words("live.none_scored"));
  if (catches > 0)
    facts.emplace_back(words("report.catch_right"), words("report.of", {whole(caught), whole(catches)}));
  add_estimates(trials, words, facts);
  facts.emplace_back(
      words("live.response_time"),
      times.empty() ? words("live.none_yet")
                    : words("live.median_last", {number(core::median(times), 3), number(times.back(), 3)}));
  facts.emplace_back(words("report.late_early"), fmt::format("{}, {}", count(trials, Outcome::timeout),
                                                             count(trials, Outcome::anticipation)));
  facts.emplace_back(words("report.void"),
                     whole(count(trials, Outcome::fault) + count(trials, Outcome::aborted)));
  if (!trials.empty()) facts.emplace_back(words("live.vibration"), vibration(trials.back().surface, words));
  facts.emplace_back("Xruns", whole(xruns));
  facts.emplace_back(words("live.other_touches"), whole(extra));
  return facts;
}

Facts limits_used(const std::vector<LiveTrial>& trials, std::optional<double> peak_displacement_m,
                  const rig::Rig& rig, const std::string& language) {
  const Words words(language);
  const auto& limits = rig.limits;
  Facts facts;
  if (peak_displacement_m)
    facts.emplace_back(
        words("live.displacement"),
        words("live.of_um", {number(1e6 * *peak_displacement_m, 3), number(1e6 * limits.displacement_m, 3),
                             percent(*peak_displacement_m / limits.displacement_m)}));
  const double now_s = trials.empty() ? 0 : trials.back().timing.onset_s + trials.back().timing.duration_s;
  double on_s = 0;
  for (const auto& trial : trials) {
    const double from = std::max(trial.timing.onset_s, now_s - kWindow_s);
    on_s += std::max(0.0, trial.timing.onset_s + trial.stimulus_s - from);
  }
  const double window_s = std::clamp(now_s, 1.0, kWindow_s);
  facts.emplace_back(words("live.duty"),
                     words("live.limit", {percent(on_s / window_s), percent(limits.duty)}));
  facts.emplace_back(words("operator.the_session"),
                     words("live.of_minutes", {number(now_s / 60, 3), number(limits.session_minutes, 3)}));
  return facts;
}

Facts sensors_of(const core::TrialRow& row, const std::optional<protocol::Sensing>& asked,
                 const std::string& language) {
  const Words words(language);
  Facts facts;
  const auto& finger = row.finger;
  using Range = std::optional<std::pair<double, double>>;
  const auto beside = [&words](std::string value, const Range& wanted, const std::string& unit,
                               const std::optional<double>& inside) {
    if (wanted)
      value =
          words("live.asked_for", {value, number(wanted->first, 3), number(wanted->second, 3) + " " + unit});
    return inside ? words("live.in_range", {value, percent(*inside)}) : value;
  };
  if (!finger.sensing.empty()) facts.emplace_back(words("report.finger"), finger.sensing);
  if (finger.normal_N)
    facts.emplace_back(words("live.normal_force"),
                       beside(fmt::format("{} N, SD {}", number(*finger.normal_N, 3),
                                          number(finger.normal_sd_N.value_or(0), 2)),
                              asked ? asked->normal_N : std::nullopt, "N", finger.normal_in_window));
  if (finger.speed_mm_s)
    facts.emplace_back(words("live.finger_speed"),
                       beside(number(*finger.speed_mm_s, 3) + " mm/s",
                              asked ? asked->speed_mm_s : std::nullopt, "mm/s", finger.speed_in_window));
  if (finger.strokes) facts.emplace_back(words("live.strokes"), std::to_string(*finger.strokes));
  if (finger.mu) facts.emplace_back(words("live.friction"), number(*finger.mu, 3));
  if (finger.tare_mN)
    facts.emplace_back(words("live.zero"), words("live.zero_moved", number(*finger.tare_mN, 2)));
  add_pick_ups(row.surface, words, facts);
  return facts;
}

std::optional<report::Figure> live_trace(const std::vector<LiveTrial>& trials, const std::string& label,
                                         const std::string& language) {
  const Words words(language);
  std::map<std::string, report::Points> series;
  std::map<std::string, report::Line> estimates;
  std::vector<double> levels;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto& trial = trials[i];
    if (!trial.level || trial.procedure.empty()) continue;
    auto& points = series[trial.procedure];
    points.x.push_back(static_cast<double>(i + 1));
    points.y.push_back(*trial.level);
    points.open.push_back(!trial.given.correct.value_or(false));
    levels.push_back(*trial.level);
    if (!trial.learned.threshold_est || !std::isfinite(*trial.learned.threshold_est)) continue;
    estimates[trial.procedure].x.push_back(static_cast<double>(i + 1));
    estimates[trial.procedure].y.push_back(*trial.learned.threshold_est);
  }
  if (levels.empty()) return std::nullopt;
  report::Chart panel;
  panel.title = words("figure.levels_open");
  panel.x = {words("figure.trial"), 0, std::max(10.0, static_cast<double>(trials.size()) + 1),
             report::AxisScale::linear, true};
  panel.y = report::fitted(label, levels, 0.1);
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

std::optional<report::Figure> live_times(const std::vector<LiveTrial>& trials, const std::string& language) {
  const Words words(language);
  report::Points points;
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (trials[i].timing.response_time_s) {
      points.x.push_back(static_cast<double>(i + 1));
      points.y.push_back(*trials[i].timing.response_time_s);
      points.open.push_back(!trials[i].given.correct.value_or(true));
    }
  if (points.x.empty()) return std::nullopt;
  report::Chart panel;
  panel.title = words("figure.times_open");
  panel.x = {words("figure.trial"), 0, std::max(10.0, static_cast<double>(trials.size()) + 1),
             report::AxisScale::linear, true};
  panel.y = report::fitted(words("figure.response_time"), points.y, 0.15);
  panel.y.low = 0;
  points.series = 2;
  panel.layers.push_back(points);
  return alone("Response times", panel);
}

}  // namespace turnpoint::view
