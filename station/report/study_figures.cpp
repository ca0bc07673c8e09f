#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "station/analysis/student.hpp"
#include "station/core/letters.hpp"
#include "station/report/chart.hpp"
#include "station/report/psychometric_parts.hpp"
#include "station/report/study.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

/// The group's psychometric function, with the mean of the participants' lower asymptotes.
DrawnFunction group_function(const analysis::MixedFit& fit) {
  double guess = 0;
  for (const auto& person : fit.persons)
    guess += person.parameters.guess / static_cast<double>(fit.persons.size());
  return {fit.options.function,
          fit.options.scale,
          {fit.threshold->value, fit.slope->value, guess, fit.lapse},
          fit.options.tied_to_lapse ? 0 : guess};
}

/// The mean of the participants' proportions, with its interval, at each level that at least three of them
/// had.
Points answers_of(const Study& study, const GroupFit& group) {
  struct Level {
    int trials = 0;
    std::vector<double> shares;
  };
  std::map<double, Level> levels;
  for (const auto& person : study.persons)
    for (const auto& named : person.fits) {
      if (!person.excluded.empty() || named.part != group.part || named.name != group.condition) continue;
      for (const auto& point : named.fit.data) {
        if (point.level == analysis::kNoise || point.trials == 0) continue;
        auto& level = levels[point.level];
        level.trials += point.trials;
        level.shares.push_back(point.sum() / point.trials);
      }
    }
  Points points;
  points.name = "mean of the participants";
  for (const auto& [at, level] : levels) {
    const auto mean = analysis::student_proportion(level.shares);
    if (!mean) continue;
    points.add(at, mean->value, mean->interval.low, mean->interval.high);
    points.weight.push_back(level.trials);
  }
  return points;
}

/// True if the group's function is known.
bool has_function(const GroupFit& group) { return group.result.fit && group.result.fit->threshold; }

/// How many participants and trials a figure shows.
struct Counted {
  std::size_t persons = 0;
  int trials = 0;
};

/// Those behind the functions of the groups.
Counted in_groups(const Study& study) {
  Counted counted;
  std::set<std::string> persons;
  for (const auto& group : study.groups)
    if (has_function(group))
      for (const auto& person : group.result.fit->persons)
        persons.insert(person.person), counted.trials += person.trials;
  counted.persons = persons.size();
  return counted;
}

/// The levels of an analysis that participants who count had; in one condition, or in all; of one person, or
/// of all.
std::vector<double> levels_of(const Study& study, std::size_t part,
                              const std::optional<std::string>& condition = {},
                              const std::optional<std::string>& only = {}) {
  std::vector<double> levels;
  for (const auto& person : study.persons)
    for (const auto& named : person.fits)
      for (const auto& point : named.fit.data)
        if (named.part == part && person.excluded.empty() && point.level != analysis::kNoise &&
            (!condition || named.name == *condition) && (!only || person.person == *only))
          levels.push_back(point.level);
  return levels;
}

/// What all captions of a study's figures begin with.
std::string of_study(const Study& study, const Counted& counted) {
  return Words("en")("figure.caption_study",
                     {study.settings.title, std::to_string(counted.persons), std::to_string(counted.trials)}) +
         " ";
}

/// All who are not excluded, with their answers.
Counted in_study(const Study& study) {
  Counted counted;
  for (const auto& person : study.persons)
    if (person.excluded.empty()) ++counted.persons, counted.trials += person.answered;
  return counted;
}

/// The answers and the functions of one condition.
Chart group_chart(const Study& study, const GroupFit& group) {
  const Words words("en");
  const auto& fit = *group.result.fit;
  const auto& part = analysis_of(group, study.settings);
  const auto whole = group_function(fit);
  const auto levels = levels_of(study, group.part, group.condition);
  const auto [first, last] = std::minmax_element(levels.begin(), levels.end());
  Chart chart;
  chart.title = group.condition;
  chart.x = level_axis(words(part.level_label), levels_of(study, group.part), fit.options.scale);
  chart.y.label = words("figure.proportion", group.positive);
  add_chance(chart, part, study.settings.alternatives, "");
  for (const auto& person : fit.persons) {
    if (!person.threshold) continue;
    auto alone = whole;
    alone.parameters = person.parameters, alone.series = kNeutral, alone.name = "participants";
    const auto own = levels_of(study, group.part, group.condition, person.person);
    if (own.empty()) continue;
    const auto [own_first, own_last] = std::minmax_element(own.begin(), own.end());
    auto i = chart.layers.size();
    add_curve(chart, alone, *first, *last, {*own_first, *own_last});
    for (; i < chart.layers.size(); ++i) std::get<Line>(chart.layers[i]).faint = true;
  }
  auto named = whole;
  named.name = "group";
  add_curve(chart, named, chart.x.low, chart.x.high, {*first, *last});
  if (auto answers = answers_of(study, group); !answers.x.empty()) chart.layers.push_back(std::move(answers));
  add_threshold(chart, whole, &fit.threshold->interval, part, words);
  return chart;
}

/// The lowest end of what the charts show.
double lowest_of(const std::vector<Chart>& charts) {
  double lowest = 1;
  const auto add = [&lowest](const std::vector<double>& values) {
    for (const double value : values) lowest = std::min(lowest, value);
  };
  for (const auto& chart : charts)
    for (const auto& layer : chart.layers) {
      if (const auto* line = std::get_if<Line>(&layer)) add(line->y);
      if (const auto* dots = std::get_if<Points>(&layer)) add(dots->y), add(dots->low);
      if (const auto* rule = std::get_if<Rule>(&layer);
          rule != nullptr && rule->direction == Rule::Direction::horizontal)
        lowest = std::min(lowest, rule->at);
    }
  return lowest;
}

/// Gives charts of the same quantity the same vertical axis.
void share_vertical_axis(std::vector<Chart>& charts, double margin) {
  const auto own = charts;
  for (auto& chart : charts) {
    std::vector<double> ends;
    for (const auto& other : own)
      if (other.y.label == chart.y.label && other.y.scale == chart.y.scale)
        ends.insert(ends.end(), {other.y.low, other.y.high});
    chart.y = fitted(chart.y.label, ends, margin, chart.y.scale);
  }
}

}  // namespace

std::optional<Figure> group_curve_figure(const Study& study) {
  Figure figure;
  figure.title = "Psychometric functions of the participants and of the group";
  for (const auto& group : study.groups)
    if (has_function(group)) figure.charts.push_back(group_chart(study, group));
  if (figure.charts.empty()) return std::nullopt;
  for (auto& chart : figure.charts)
    chart.y = proportion_axis(std::move(chart.y.label), lowest_of(figure.charts));
  figure.caption = of_study(study, in_groups(study)) + Words("en")("figure.caption_group");
  if (has_silent_chance(figure)) figure.caption += " " + Words("en")("figure.caption_chance");
  if (goes_beyond(figure)) figure.caption += " " + Words("en")("figure.caption_beyond");
  return on_page(std::move(figure), 330);
}

namespace {

/// The name of an axis of thresholds, with the proportion that they stand for.
std::string threshold_axis(const GroupFit& group, const LevelAnalysis& part) {
  auto name = core::phrase(part.design == Design::two_sided ? "report.pse" : "report.threshold");
  if (part.design == Design::forced_choice)
    name = core::phrase("figure.threshold_at",
                        {core::plain(in_percent(criterion(group_function(*group.result.fit))))});
  auto label = core::say(in_unit(std::move(name), core::plain(part.level_unit)), "en");
  label[0] = core::upper(label[0]);
  return label;
}

/// The thresholds of the participants in one condition, with partial pooling and alone.
Chart thresholds_chart(const Study& study, const GroupFit& group) {
  constexpr double apart = 0.13;
  const auto& fit = *group.result.fit;
  const auto& part = analysis_of(group, study.settings);
  Chart chart;
  Points alone, without_interval, pooled;
  alone.name = "alone", alone.series = report::kNeutral;
  without_interval = alone;
  pooled.name = "partial pooling";
  std::vector<double> all{fit.threshold->interval.low, fit.threshold->interval.high};
  double number = 0;
  for (const auto& person : fit.persons) {
    ++number;
    chart.x.names.push_back(person.person);
    if (person.threshold) {
      const auto& [low, high, confidence] = person.threshold->interval;
      pooled.add(number - apart, person.threshold->value, low, high);
      all.insert(all.end(), {person.threshold->value, low, high});
    }
    for (const auto& single : study.persons)
      for (const auto& named : single.fits) {
        if (single.person != person.person || named.name != group.condition || !named.fit.parameters)
          continue;
        const double at = named.fit.parameters->threshold;
        const auto& interval = named.intervals.threshold;
        // the axis cuts what a fit of few answers leaves open
        auto& own = interval ? alone : without_interval;
        if (interval)
          own.add(number + apart, at, interval->interval.low, interval->interval.high);
        else
          own.x.push_back(number + apart), own.y.push_back(at);
        own.open.push_back(true), all.push_back(at);
      }
  }
  chart.title = group.condition;
  chart.x.label = "Participant", chart.x.low = 0.4, chart.x.high = number + 0.6, chart.x.counts = true;
  chart.y = fitted(threshold_axis(group, part), all, 0.04,
                   fit.options.scale == analysis::Scale::log10 ? AxisScale::log10 : AxisScale::linear);
  const auto& interval = fit.threshold->interval;
  chart.layers = {Band{{chart.x.low, chart.x.high},
                       {interval.low, interval.low},
                       {interval.high, interval.high},
                       kNeutral,
                       ""},
                  Rule{Rule::Direction::horizontal, fit.threshold->value, ""}};
  for (auto* points : {&alone, &without_interval, &pooled})
    if (!points->x.empty()) chart.layers.push_back(std::move(*points));
  return chart;
}

}  // namespace

std::optional<Figure> shrinkage_figure(const Study& study) {
  Figure figure;
  figure.title = "Thresholds of the participants, alone and with partial pooling";
  for (const auto& group : study.groups)
    if (has_function(group)) figure.charts.push_back(thresholds_chart(study, group));
  if (figure.charts.empty()) return std::nullopt;
  share_vertical_axis(figure.charts, 0.01);
  const bool posterior = study.settings.prior.has_value();
  const Words words("en");
  figure.caption = of_study(study, in_groups(study)) +
                   words("figure.caption_shrinkage", words(posterior ? "figure.credible" : "figure.profile"));
  return on_page(std::move(figure), 260);
}

std::optional<Figure> group_trade_figure(const Study& study) {
  Chart chart;
  std::vector<double> times, accuracies;
  std::vector<std::string> conditions;
  for (const auto& mean : study.means)
    if (mean.measure == analysis::kCorrect) conditions.push_back(mean.condition);
  const auto mean_of = [&study](const std::string& measure, const std::string& condition) {
    const auto found = std::find_if(study.means.begin(), study.means.end(), [&](const auto& mean) {
      return mean.measure == measure && mean.condition == condition;
    });
    return found == study.means.end() ? std::nullopt : found->mean;
  };
  int series = 0;
  std::map<std::string, Line> joined;  // one person's conditions
  std::vector<Layer> means;
  for (const auto& condition : conditions) {
    Points points, mean;
    points.series = mean.series = series++;
    points.name = conditions.size() > 1 ? condition : "";
    if (const auto time = mean_of(analysis::kMedianTime, condition),
        accuracy = mean_of(analysis::kCorrect, condition);
        time && accuracy) {
      mean.add(time->value, accuracy->value, accuracy->interval.low, accuracy->interval.high);
      means.push_back(Span{time->interval.low, time->interval.high, accuracy->value, mean.series, true});
      means.push_back(mean);
      times.insert(times.end(), {time->interval.low, time->interval.high});
      accuracies.push_back(accuracy->interval.low);
    }
    for (const auto& person : study.persons) {
      std::optional<double> time, accuracy;
      for (const auto& measure : person.measures) {
        if (measure.condition != condition) continue;
        if (measure.measure == analysis::kMedianTime) time = measure.value;
        if (measure.measure == analysis::kCorrect) accuracy = measure.value;
      }
      if (!time || !accuracy || !person.excluded.empty()) continue;
      points.x.push_back(*time), points.y.push_back(*accuracy), points.open.push_back(true);
      auto& line = joined[person.person];
      line.x.push_back(*time), line.y.push_back(*accuracy);
    }
    times.insert(times.end(), points.x.begin(), points.x.end());
    accuracies.insert(accuracies.end(), points.y.begin(), points.y.end());
    if (!points.x.empty()) chart.layers.push_back(std::move(points));
  }
  if (times.empty()) return std::nullopt;
  chart.layers.insert(chart.layers.end(), means.begin(), means.end());
  for (auto& [person, line] : joined) {
    line.series = report::kNeutral, line.faint = true;
    if (line.x.size() > 1) chart.layers.insert(chart.layers.begin(), std::move(line));
  }
  chart.x = report::fitted("Median response time (s)", times, 0.1);
  const double lowest = *std::min_element(accuracies.begin(), accuracies.end());
  chart.y = proportion_axis("Proportion correct (0 to 1)", lowest);
  Figure figure;
  figure.title = "Speed and accuracy of each participant";
  figure.caption = of_study(study, in_study(study)) + Words("en")("figure.caption_persons");
  figure.chart_width_px = 620;
  figure.chart_height_px = 330;
  figure.charts.push_back(std::move(chart));
  return figure;
}

namespace {

/// A chart of the means of one measure against those of another, by condition. `heights` and `times` are the
/// names of the measures, or what these begin with.
std::optional<Chart> course_chart(const Study& study, const std::string& heights, const std::string& times,
                                  bool joins_conditions) {
  Chart chart{"", {}, {}, {}};
  std::vector<double> xs, ys;
  std::vector<std::string> conditions;
  std::vector<std::pair<double, double>> across_conditions;
  for (const auto& mean : study.means)
    if (mean.measure.starts_with(heights) &&
        std::find(conditions.begin(), conditions.end(), mean.condition) == conditions.end())
      conditions.push_back(mean.condition);
  int series = 0;
  for (const auto& condition : conditions) {
    Points points;
    Line line;
    points.series = line.series = series++;
    points.name = core::say(name_of(condition), "en");
    for (const auto& height : study.means) {
      if (!height.measure.starts_with(heights) || height.condition != condition || !height.mean) continue;
      const auto wanted = times + height.measure.substr(heights.size());
      for (const auto& time : study.means) {
        if (time.measure != wanted || time.condition != condition || !time.mean) continue;
        const auto &x = *time.mean, &y = *height.mean;
        points.add(x.value, y.value, y.interval.low, y.interval.high);
        chart.layers.push_back(Span{x.interval.low, x.interval.high, y.value, points.series, true});
        xs.insert(xs.end(), {x.interval.low, x.interval.high});
        ys.insert(ys.end(), {y.interval.low, y.interval.high});
      }
    }
    if (points.x.empty()) continue;
    line.x = points.x, line.y = points.y;
    if (joins_conditions)
      across_conditions.emplace_back(points.x.front(), points.y.front());
    else
      chart.layers.push_back(line);
    chart.layers.push_back(points);
  }
  if (xs.empty() || (joins_conditions && across_conditions.size() < 2)) return std::nullopt;
  std::sort(across_conditions.begin(), across_conditions.end());
  Line joined;
  joined.series = report::kNeutral;
  for (const auto& [x, y] : across_conditions) joined.x.push_back(x), joined.y.push_back(y);
  if (joins_conditions) chart.layers.insert(chart.layers.begin(), joined);
  chart.x = report::fitted("Response time (s)", xs, 0.1);
  chart.y = report::fitted("", ys, 0.08);
  return chart;
}

}  // namespace

std::optional<Figure> group_course_figure(const Study& study) {
  Figure figure;
  const auto add = [&](const char* title, const char* y, const std::string& heights, const std::string& times,
                       bool joins_conditions) {
    auto chart = course_chart(study, heights, times, joins_conditions);
    if (!chart) return;
    chart->title = title, chart->y.label = y;
    if (heights == analysis::kBinMeasure) chart->y = proportion_axis(y, chart->y.low);
    figure.charts.push_back(std::move(*chart));
  };
  add("Conditional accuracy", "Proportion correct (0 to 1)", analysis::kBinMeasure, kBinTime, false);
  add("Sensitivity at the signal", "Sensitivity d\u2032", kLagSensitivity, kLagTime, false);
  if (!study.settings.signalled)
    add("Sensitivity over the conditions", "Sensitivity d\u2032", analysis::kSensitivity,
        analysis::kMedianTime, true);
  if (figure.charts.empty()) return std::nullopt;
  figure.title = "Accuracy over time, means of the participants";
  figure.caption = of_study(study, in_study(study)) + Words("en")("figure.caption_course");
  return on_page(std::move(figure), 330);
}

}  // namespace turnpoint::report
