#include <algorithm>
#include <cmath>
#include <map>

#include "station/analysis/student.hpp"
#include "station/report/chart.hpp"
#include "station/report/study.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

Line curve_of(const analysis::MixedOptions& options, const analysis::Psychometric& parameters,
              const Axis& axis, int series) {
  Line line;
  line.series = series;
  for (int i = 0; i <= 80; ++i) {
    const double share = i / 80.0;
    const double x = axis.scale == AxisScale::log10 ? axis.low * std::pow(axis.high / axis.low, share)
                                                    : axis.low + share * (axis.high - axis.low);
    line.x.push_back(x);
    line.y.push_back(analysis::probability(options.function, options.scale, parameters, x));
  }
  return line;
}

/// The group's psychometric function, with the mean of the participants' lower asymptotes.
analysis::Psychometric group_parameters(const analysis::MixedFit& fit) {
  double guess = 0;
  for (const auto& person : fit.persons)
    guess += person.parameters.guess / static_cast<double>(fit.persons.size());
  return {fit.threshold->value, fit.slope->value, guess, fit.lapse};
}

/// The mean of the participants' proportions, with its interval, at each level that at least three of them
/// had.
Points answers_of(const Study& study, const GroupFit& group, int series) {
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
  points.series = series;
  points.name = "mean of the participants";
  for (const auto& [at, level] : levels) {
    const auto mean = level.shares.size() < 3 ? std::nullopt : analysis::student_mean(level.shares);
    if (!mean) continue;
    points.add(at, mean->value, std::max(0.0, mean->interval.low), std::min(1.0, mean->interval.high));
    points.weight.push_back(level.trials);
  }
  return points;
}

int trials_of(const Study& study) {
  int trials = 0;
  for (const auto& group : study.groups)
    if (group.result.fit)
      for (const auto& person : group.result.fit->persons) trials += person.trials;
  return trials;
}

std::size_t persons_of(const Study& study) {
  return static_cast<std::size_t>(std::count_if(study.persons.begin(), study.persons.end(),
                                                [](const auto& person) { return person.excluded.empty(); }));
}

std::vector<double> levels_of(const Study& study, std::size_t part) {
  std::vector<double> levels;
  for (const auto& person : study.persons)
    for (const auto& named : person.fits)
      for (const auto& point : named.fit.data)
        if (named.part == part && person.excluded.empty() && point.level != analysis::kNoise)
          levels.push_back(point.level);
  return levels;
}

}  // namespace

std::optional<Figure> group_curve_figure(const Study& study) {
  Figure figure;
  figure.title = "Psychometric functions of the participants and of the group";
  figure.columns = study.groups.size() > 1 ? 2 : 1;
  figure.chart_width_px = study.groups.size() > 1 ? 400 : 620;
  figure.chart_height_px = 330;
  int series = -1;
  for (const auto& group : study.groups) {
    ++series;
    if (!group.result.fit || !group.result.fit->threshold) continue;
    const auto& fit = *group.result.fit;
    Chart chart;
    chart.title = core::say(name_of(group.condition), "en");
    const auto& part = analysis_of(group, study.settings);
    chart.x =
        report::fitted(core::say(part.level_label, "en"), levels_of(study, group.part), 0.05,
                       fit.options.scale == analysis::Scale::log10 ? AxisScale::log10 : AxisScale::linear);
    chart.y = {"Proportion " + group.positive + " (0 to 1)", -0.03, 1.03};
    if (part.design == Design::forced_choice) chart.y.low = 0.3;
    for (const auto& person : fit.persons) {
      if (!person.threshold) continue;
      auto alone = curve_of(fit.options, person.parameters, chart.x, report::kNeutral);
      alone.name = "participants", alone.faint = true;
      chart.layers.push_back(std::move(alone));
    }
    auto whole = curve_of(fit.options, group_parameters(fit), chart.x, series);
    whole.name = "group";
    chart.layers.push_back(std::move(whole));
    if (auto answers = answers_of(study, group, series); !answers.x.empty())
      chart.layers.push_back(std::move(answers));
    figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption = Words("en")("figure.caption_group",
                               {std::to_string(persons_of(study)), std::to_string(trials_of(study))});
  return figure;
}

std::optional<Figure> shrinkage_figure(const Study& study) {
  Figure figure;
  figure.title = "Thresholds of the participants, alone and with partial pooling";
  figure.chart_width_px = 620;
  figure.chart_height_px = 260;
  int series = -1;
  for (const auto& group : study.groups) {
    ++series;
    if (!group.result.fit || !group.result.fit->threshold) continue;
    Points alone, pooled;
    alone.name = "alone", alone.series = report::kNeutral;
    pooled.name = "partial pooling", pooled.series = series;
    std::vector<double> all;
    double number = 0;
    std::vector<std::string> codes;
    for (const auto& person : group.result.fit->persons) {
      ++number;
      codes.push_back(person.person);
      if (person.threshold) {
        const auto& [low, high, confidence] = person.threshold->interval;
        pooled.add(number, person.threshold->value, low, high);
        all.insert(all.end(), {person.threshold->value, low, high});
      }
      for (const auto& single : study.persons)
        for (const auto& named : single.fits)
          if (single.person == person.person && named.name == group.condition && named.fit.parameters) {
            alone.x.push_back(number + 0.25), alone.y.push_back(named.fit.parameters->threshold);
            alone.open.push_back(true), all.push_back(alone.y.back());
          }
    }
    if (all.empty()) continue;
    Chart chart;
    chart.title = core::say(name_of(group.condition), "en");
    chart.x = {"Participant", 0.4, number + 0.6, AxisScale::linear, true, codes};
    chart.y = report::fitted(core::say(analysis_of(group, study.settings).level_label, "en"), all, 0.08);
    chart.layers.push_back(Rule{Rule::Direction::horizontal, group.result.fit->threshold->value, "group"});
    chart.layers.push_back(alone);
    chart.layers.push_back(pooled);
    figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption = Words("en")("figure.caption_shrinkage", std::to_string(persons_of(study)));
  return figure;
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
      means.push_back(Span{time->interval.low, time->interval.high, accuracy->value, mean.series});
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
  chart.y = {"Proportion correct (0 to 1)", std::min(0.45, lowest - 0.03), 1.03};
  Figure figure;
  figure.title = "Speed and accuracy of each participant";
  figure.caption = Words("en")("figure.caption_persons", std::to_string(persons_of(study)));
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
        chart.layers.push_back(Span{x.interval.low, x.interval.high, y.value, points.series});
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
    figure.charts.push_back(std::move(*chart));
  };
  add("Conditional accuracy", "Proportion correct (0 to 1)", analysis::kBinMeasure, kBinTime, false);
  add("Sensitivity at the signal", "Sensitivity d\u2032", kLagSensitivity, kLagTime, false);
  if (!study.settings.signalled)
    add("Sensitivity over the conditions", "Sensitivity d\u2032", analysis::kSensitivity,
        analysis::kMedianTime, true);
  if (figure.charts.empty()) return std::nullopt;
  figure.title = "Accuracy over time, means of the participants";
  figure.caption = Words("en")("figure.caption_course", std::to_string(persons_of(study)));
  figure.columns = figure.charts.size() > 1 ? 2 : 1;
  figure.chart_width_px = figure.columns > 1 ? 400 : 620;
  figure.chart_height_px = 330;
  return figure;
}

}  // namespace turnpoint::report
