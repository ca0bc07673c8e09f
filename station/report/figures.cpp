#include "station/report/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/core/number.hpp"
#include "station/report/psychometric_parts.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

/// A cell contains the trials of one condition with equal difficulty. Cells with fewer trials than
/// kFewestOfCell are left out of the figure.
constexpr int kFewestOfCell = 5;
// a level below this, from a surface that hardly moves, is drawn at this level
constexpr double kLowestLevel_dB = -40;

Points observed(const NamedFit& named, int series, const std::string& name) {
  Points points;
  points.series = series;
  points.name = name;
  for (const auto& point : named.fit.data) {
    if (point.level == analysis::kNoise) continue;
    const auto interval = analysis::wilson(point.sum(), point.trials);
    points.add(point.level, point.sum() / point.trials, interval.low, interval.high);
    points.weight.push_back(point.trials);
  }
  return points;
}

DrawnFunction drawn_of(const NamedFit& named, int series, const std::string& name) {
  const auto& options = named.fit.options;
  const double guess = options.guess == analysis::Guess::fixed    ? options.guess_value
                       : options.guess == analysis::Guess::fitted ? named.fit.parameters->guess
                                                                  : 0;
  return {options.function, options.scale, *named.fit.parameters, guess, series, name};
}

std::vector<double> levels_of(const std::vector<const NamedFit*>& fits) {
  std::vector<double> levels;
  for (const auto* named : fits)
    for (const auto& point : named->fit.data)
      if (point.level != analysis::kNoise) levels.push_back(point.level);
  return levels;
}

/// Adds the fitted curve, which ends where its band does.
void add_curve(const NamedFit& named, const DrawnFunction& drawn, Chart& panel) {
  const auto& along = named.intervals.band_level;
  const auto levels = levels_of({&named});
  const auto [first, last] = std::minmax_element(levels.begin(), levels.end());
  add_curve(panel, drawn, along.empty() ? panel.x.low : along.front(),
            along.empty() ? panel.x.high : along.back(), {*first, *last});
}

/// Returns the proportion of "yes" answers in trials without a signal.
std::optional<double> false_alarms(const NamedFit& named) {
  for (const auto& point : named.fit.data)
    if (point.level == analysis::kNoise) return point.sum() / point.trials;
  return std::nullopt;
}

std::string of_answers(const Summary& summary) {
  std::size_t answered = 0;
  for (const auto& entry : summary.trade.instructions)
    answered += static_cast<std::size_t>(entry.answered - entry.excluded);
  return of_trials(summary.data, answered);
}

const char* curve_caption(core::Function function) {
  switch (function) {
    case core::Function::normal:
      return "figure.caption_normal";
    case core::Function::logistic:
      return "figure.caption_logistic";
    case core::Function::weibull:
      break;
  }
  return "figure.caption_weibull";
}

std::string psychometric_caption(const Summary& summary, const Figure& figure) {
  const Words words(summary.data.language);
  std::size_t trials = 0;
  bool bands = false, thresholds = false;
  auto method = analysis::IntervalMethod::none;
  for (const auto& named : summary.fits) {
    for (const auto& point : named.fit.data) trials += static_cast<std::size_t>(point.trials);
    bands = bands || !named.intervals.band_level.empty();
    thresholds = thresholds || named.intervals.threshold;
    if (named.intervals.method != analysis::IntervalMethod::none) method = named.intervals.method;
  }
  const bool posterior = method == analysis::IntervalMethod::posterior;
  auto caption =
      of_trials(summary.data, trials) + " " +
      words.together({"figure.caption_points", curve_caption(summary.fits.front().fit.options.function)});
  if (goes_beyond(figure)) caption += " " + words("figure.caption_beyond");
  if (has_silent_chance(figure)) caption += " " + words("figure.caption_chance");
  if (bands)
    caption +=
        " " + words("figure.caption_band", words(posterior ? "figure.credible" : "figure.percentiles"));
  if (thresholds)
    caption +=
        " " + words("figure.caption_threshold", words(posterior ? "figure.credible" : "figure.profile"));
  return caption;
}

}  // namespace

std::string of_trials(const SessionData& data, std::size_t trials) {
  return (data.title.empty() ? "" : data.title + ". ") +
         Words(data.language)("figure.caption_trials", {data.participant, std::to_string(trials)});
}

namespace {

/// The lowest proportion that charts of these functions show.
double lowest_of(const std::vector<const NamedFit*>& fits, Design design, int alternatives) {
  if (design != Design::forced_choice) return 0;
  double lowest = 1.0 / alternatives;
  for (const auto* named : fits) {
    for (const auto& point : named->fit.data)
      lowest = std::min(lowest, analysis::wilson(point.sum(), point.trials).low);
    for (const double low : named->intervals.band_low) lowest = std::min(lowest, low);
  }
  return lowest;
}

/// An empty chart for all functions of one analysis; nullopt if there are no levels.
std::optional<Chart> psychometric_axes(const std::vector<const NamedFit*>& fits, const LevelAnalysis& data,
                                       int alternatives, const Words& words) {
  const auto levels = levels_of(fits);
  if (levels.empty()) return std::nullopt;
  Chart panel;
  panel.title = data.name;
  panel.x = level_axis(words(data.level_label), levels, data.scale);
  const auto& positive = fits.front()->positive;
  panel.y =
      proportion_axis(words("figure.proportion", positive == "correct" ? words("figure.correct") : positive),
                      lowest_of(fits, data.design, alternatives));
  return panel;
}

/// Adds functions to a chart; `series` is that of the first, `chance` the label of the line at the chance
/// level.
void add_functions(const std::vector<const NamedFit*>& fits, const LevelAnalysis& data, int alternatives,
                   int series, const std::string& chance, const Words& words, Chart& panel) {
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (const auto& band = fits[i]->intervals; !band.band_level.empty())
      panel.layers.push_back(
          Band{band.band_level, band.band_low, band.band_high, series + static_cast<int>(i), ""});
  add_chance(panel, data, alternatives, chance);
  if (has_noise(data.design))
    for (const auto* named : fits)
      if (const auto noise = false_alarms(*named))
        panel.layers.push_back(Rule{Rule::Direction::horizontal, *noise,
                                    named->name.empty() || fits.size() == 1
                                        ? words("figure.false_alarms")
                                        : words("figure.false_alarms_of", named->name)});
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const auto& named = *fits[i];
    const int own = series + static_cast<int>(i);
    const auto name = fits.size() > 1 ? named.name : std::string();
    if (named.fit.parameters && !levels_of({&named}).empty())
      add_curve(named, drawn_of(named, own, name), panel);
    panel.layers.push_back(observed(named, own, name));
  }
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (const auto& named = *fits[i]; named.fit.parameters)
      add_threshold(panel, drawn_of(named, series + static_cast<int>(i), fits.size() > 1 ? named.name : ""),
                    named.intervals.threshold ? &named.intervals.threshold->interval : nullptr, data, words);
}

/// More functions than these in one chart would hide each other: each then has a chart of its own.
constexpr std::size_t kMostTogether = 2;

/// The charts of the functions of one analysis.
std::vector<Chart> psychometric_charts(const std::vector<const NamedFit*>& fits, const SessionData& session,
                                       const Words& words) {
  const auto& data = analysis_of(*fits.front(), session);
  const auto axes = psychometric_axes(fits, data, session.alternatives, words);
  if (!axes) return {};
  if (fits.size() <= kMostTogether) {
    auto panel = *axes;
    add_functions(fits, data, session.alternatives, 0, words("figure.chance"), words, panel);
    return {std::move(panel)};
  }
  std::vector<Chart> charts;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    charts.push_back(*axes);
    charts.back().title = fits[i]->name;
    add_functions({fits[i]}, data, session.alternatives, static_cast<int>(i), "", words, charts.back());
  }
  return charts;
}

}  // namespace

std::optional<Figure> psychometric_figure(const Summary& summary) {
  Figure figure;
  figure.title = "Psychometric function";
  const Words words(summary.data.language);
  for (std::size_t part = 0; part < std::max<std::size_t>(1, summary.data.parts.size()); ++part) {
    std::vector<const NamedFit*> fits;
    for (const auto& named : summary.fits)
      if (named.part == part) fits.push_back(&named);
    if (fits.empty()) continue;
    for (auto& chart : psychometric_charts(fits, summary.data, words))
      figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption = psychometric_caption(summary, figure);
  return on_page(std::move(figure), 380);
}

std::optional<Figure> trace_figure(const Summary& summary) {
  Figure figure;
  const Words words(summary.data.language);
  figure.title = "Levels in the order presented";
  figure.chart_width_px = 620;
  figure.chart_height_px = 240;
  std::size_t trials = 0;
  for (const auto& trace : summary.traces) {
    trials += trace.points.size();
    Points right, wrong;
    Line line;
    line.series = report::kNeutral;
    for (const auto& point : trace.points) {
      const bool is_wrong = point.correct && !*point.correct;
      auto& points = is_wrong ? wrong : right;
      points.x.push_back(point.trial_index + 1);
      points.y.push_back(point.level);
      points.open.push_back(is_wrong);
      line.x.push_back(points.x.back());
      line.y.push_back(points.y.back());
    }
    if (!wrong.x.empty()) right.name = words("figure.right"), wrong.name = words("figure.wrong");
    Chart panel;
    panel.title = trace.procedure;
    panel.x = report::fitted(words("figure.trial_in_session"), line.x, 0.03);
    panel.x.counts = true;
    panel.y = report::fitted(words(summary.data.level_label), line.y, 0.1);
    // Draw a line only if the procedure moves in small steps. A line through shuffled levels would only
    // zigzag.
    double steps = 0;
    for (std::size_t i = 1; i < line.y.size(); ++i) steps += std::abs(line.y[i] - line.y[i - 1]);
    const bool smooth = line.y.size() > 1 &&
                        steps / static_cast<double>(line.y.size() - 1) < 0.2 * (panel.y.high - panel.y.low);
    if (smooth) panel.layers.push_back(line);
    panel.layers.push_back(right);
    panel.layers.push_back(wrong);
    figure.charts.push_back(std::move(panel));
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption = of_trials(summary.data, trials) + " " + words("figure.caption_trace");
  return figure;
}

std::optional<Figure> settings_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Figure figure;
  std::size_t count = 0;
  figure.title = "Settings in the order made";
  figure.chart_width_px = 620;
  figure.chart_height_px = 260;
  for (const auto& settings : summary.settings) {
    Points starts, ends;
    count += settings.values.size();
    starts.name = "start", starts.series = report::kNeutral;
    ends.name = "setting", ends.series = static_cast<int>(figure.charts.size());
    for (std::size_t i = 0; i < settings.values.size(); ++i) {
      starts.x.push_back(static_cast<double>(i + 1));
      starts.y.push_back(settings.starts[i]);
      starts.open.push_back(true);
      ends.y.push_back(settings.values[i]);
    }
    ends.x = starts.x;
    auto both = starts.y;
    both.insert(both.end(), ends.y.begin(), ends.y.end());
    Chart panel;
    panel.title = settings.procedure + (settings.condition.empty() ? "" : ", " + settings.condition);
    panel.x = report::fitted("Setting (number)", starts.x, 0.03);
    panel.y = report::fitted(words(summary.data.level_label), both, 0.1);
    if (settings.mean)
      panel.layers.push_back(Rule{Rule::Direction::horizontal, settings.mean->value,
                                  "mean " + in_digits(settings.mean->value, &settings.mean->interval)});
    panel.layers.push_back(starts);
    panel.layers.push_back(ends);
    figure.charts.push_back(std::move(panel));
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption = of_trials(summary.data, count) + " " + words("figure.caption_settings");
  return figure;
}

std::optional<Figure> judgement_figure(const Summary& summary) {
  const Words words(summary.data.language);
  const bool numbers = summary.data.design == Design::numbers;
  Chart chart;
  std::vector<double> levels, values;
  std::size_t count = 0;
  for (const auto& judged : summary.judgements) {
    Points points;
    Line line;
    points.series = line.series = static_cast<int>(chart.layers.size()) / 2;
    if (!judged.condition.empty()) points.name = judged.condition;
    for (const auto& level : judged.levels) {
      count += level.values.size();
      if (!level.mean) continue;
      points.add(level.level, level.mean->value, level.mean->interval.low, level.mean->interval.high);
    }
    if (points.x.empty()) continue;
    line.x = points.x, line.y = points.y;
    levels.insert(levels.end(), points.x.begin(), points.x.end());
    for (const auto* ends : {&points.low, &points.high})
      values.insert(values.end(), ends->begin(), ends->end());
    chart.layers.insert(chart.layers.end(), {line, points});
  }
  if (levels.empty()) return std::nullopt;
  const bool ratios =
      numbers && summary.data.level_unit != "dB" && *std::min_element(levels.begin(), levels.end()) > 0;
  const auto scale = [](bool logarithmic) { return logarithmic ? AxisScale::log10 : AxisScale::linear; };
  chart.x = report::fitted(words(summary.data.level_label), levels, 0.06, scale(ratios));
  chart.y = report::fitted(words(numbers ? "figure.geometric_mean" : "figure.mean_rating"), values, 0.08,
                           scale(numbers));
  Figure figure;
  figure.title = numbers ? "Numbers at each level" : "Ratings at each level";
  figure.chart_width_px = 620;
  figure.chart_height_px = 320;
  figure.caption = of_trials(summary.data, count) + " " +
                   words(numbers ? "figure.caption_numbers" : "figure.caption_ratings");
  figure.charts.push_back(std::move(chart));
  return figure;
}

std::optional<Figure> scale_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Chart chart;
  std::vector<double> stimuli, values;
  std::size_t count = 0;
  for (const auto& scale : summary.scales) {
    if (!scale.fit) continue;
    count += static_cast<std::size_t>(scale.trials);
    Points points;
    Line line;
    points.series = line.series = static_cast<int>(chart.layers.size()) / 2;
    if (!scale.condition.empty()) points.name = scale.condition;
    for (std::size_t i = 0; i < scale.stimuli.size(); ++i) {
      const auto& at = scale.fit->values[i];
      points.add(scale.stimuli[i], at.value, at.interval.low, at.interval.high);
    }
    line.x = points.x, line.y = points.y;
    stimuli.insert(stimuli.end(), points.x.begin(), points.x.end());
    for (const auto* ends : {&points.low, &points.high})
      values.insert(values.end(), ends->begin(), ends->end());
    chart.layers.insert(chart.layers.end(), {line, points});
  }
  if (stimuli.empty()) return std::nullopt;
  chart.x = report::fitted(words(summary.data.level_label), stimuli, 0.06);
  chart.y = report::fitted(words(place_label(summary.scales.front().model)), values, 0.08);
  Figure figure;
  figure.title = "Scale of the stimuli";
  figure.chart_width_px = 620;
  figure.chart_height_px = 320;
  figure.caption = of_trials(summary.data, count) + " " + words("figure.caption_scale");
  figure.charts.push_back(std::move(chart));
  return figure;
}

std::optional<Figure> before_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Figure figure;
  std::size_t count = 0;
  std::map<std::string, std::array<std::vector<double>, 2>> drawn;  // by the label of the vertical axis
  for (const auto& entry : summary.dependences) {
    if (entry.curve.empty()) continue;
    Chart chart;
    chart.title = entry.condition.empty() ? entry.analysis : entry.condition;
    const bool logarithms = entry.how.answers == analysis::Answers::logarithms, ratios = entry.how.decibel;
    chart.x.label = words("report.previous_stimulus");
    if (!entry.unit.empty() && !ratios) chart.x.label += " (" + entry.unit + ")";
    if (logarithms) chart.x.scale = AxisScale::log10;
    chart.y.label = entry.answer.empty() ? words("figure.shift") : words("figure.shift_of", entry.answer);
    Points points;
    Line line;
    points.series = line.series = static_cast<int>(figure.charts.size());
    double mean = 0;
    for (const auto& point : entry.curve) mean += point.stimulus / static_cast<double>(entry.curve.size());
    for (const auto& point : entry.curve) {
      count += static_cast<std::size_t>(point.pairs);
      const double at = logarithms ? std::pow(10, point.stimulus) : point.stimulus;
      points.add(at, point.shift.value, point.shift.interval.low, point.shift.interval.high);
      points.weight.push_back(point.pairs);
      line.x.push_back(at);
      line.y.push_back(entry.previous_stimulus->value * (point.stimulus - mean));
    }
    auto& [x, y] = drawn[chart.y.label];
    x.insert(x.end(), points.x.begin(), points.x.end());
    for (const auto* ends : {&points.low, &points.high, &line.y})
      y.insert(y.end(), ends->begin(), ends->end());
    chart.layers = {Rule{Rule::Direction::horizontal, 0, ""}, line, points};
    figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return std::nullopt;
  for (auto& chart : figure.charts) {
    const auto& [x, y] = drawn[chart.y.label];
    chart.x = report::fitted(chart.x.label, x, 0.06, chart.x.scale);
    chart.y = report::fitted(chart.y.label, y, 0.08);
  }
  figure.title = "The answer after each stimulus";
  figure.chart_width_px = 620;
  figure.chart_height_px = 320;
  const bool logistic =
      std::ranges::any_of(summary.dependences, [](const auto& one) { return !one.answer.empty(); });
  figure.caption = of_trials(summary.data, count) + " " +
                   words("figure.caption_before", words(logistic ? "figure.penalised" : "figure.student"));
  return figure;
}

std::optional<Figure> confusion_figure(const Summary& summary) {
  const auto edges = [](std::size_t count) {
    std::vector<double> all;
    for (std::size_t i = 0; i <= count; ++i) all.push_back(static_cast<double>(i) + 0.5);
    return all;
  };
  Figure figure;
  const Words words(summary.data.language);
  std::size_t trials = 0;
  figure.title = "Answers to each stimulus";
  figure.chart_width_px = 620;
  figure.chart_height_px = 380;
  for (const auto& confusion : summary.confusions) {
    if (confusion.rows.empty()) continue;
    for (const auto& row : confusion.rows) trials += static_cast<std::size_t>(row.trials);
    HeatMap shares{
        edges(summary.data.choices.size()), edges(confusion.rows.size()), {}, 0, 1, words("figure.share")};
    for (const auto& row : confusion.rows)
      for (const int count : row.answers) shares.values.push_back(static_cast<double>(count) / row.trials);
    Chart chart;
    chart.title = confusion.condition;
    chart.x = {words("figure.answer"), 0.5,  shares.x_edges.back(),
               AxisScale::linear,      true, summary.data.choices};
    chart.y = {words("figure.stimulus"), 0.5, shares.y_edges.back(), AxisScale::linear, true};
    for (const auto& row : confusion.rows)
      chart.y.names.push_back(row.stimulus ? summary.data.choices.at(static_cast<std::size_t>(*row.stimulus))
                              : row.level  ? in_digits(*row.level, nullptr)
                                           : "");
    chart.layers.push_back(std::move(shares));
    figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption = of_trials(summary.data, trials);
  return figure;
}

std::optional<Figure> vibration_figure(const Summary& summary) {
  if (summary.data.measured.empty()) return std::nullopt;
  Points points;
  for (const auto& trial : summary.data.measured) {
    points.x.push_back(trial.trial_index + 1);
    points.y.push_back(std::max(trial.level_dB, kLowestLevel_dB));
    points.open.push_back(!trial.counts);
  }
  Chart chart;
  chart.x = report::fitted("Trial (number)", points.x, 0.03);
  chart.x.counts = true;
  auto levels = points.y;
  // the axis always includes 0.6 dB below and above the plan, beyond the 0.5 dB of ProofLimits::level_dB
  levels.insert(levels.end(), {-0.6, 0.6});
  chart.y = report::fitted("Measured against plan (dB)", levels, 0.1);
  chart.layers.push_back(Rule{Rule::Direction::horizontal, 0, "as planned"});
  chart.layers.push_back(points);
  Figure figure;
  figure.title = "Vibration of the surface";
  figure.caption = of_trials(summary.data, points.x.size()) + " " +
                   Words(summary.data.language)("figure.caption_vibration");
  figure.chart_width_px = 620;
  figure.chart_height_px = 220;
  figure.charts.push_back(std::move(chart));
  return figure;
}

std::optional<Figure> response_time_figure(const Summary& summary) {
  std::vector<double> all;
  for (const auto& entry : summary.trade.instructions)
    all.insert(all.end(), entry.times_s.begin(), entry.times_s.end());
  if (all.size() < 5) return std::nullopt;
  const double width = std::pow(10.0, std::floor(std::log10(analysis::quantile(all, 0.98)))) / 4;
  const double high = std::ceil(analysis::quantile(all, 1) / width) * width;
  const int bins = std::clamp(static_cast<int>(std::lround(high / width)) * 2, 10, 60);
  Figure figure;
  const Words words(summary.data.language);
  figure.title = "Response times";
  figure.chart_width_px = 620;
  figure.chart_height_px = 200;
  double tallest = 1;
  std::vector<Histogram> bars;
  for (const auto& entry : summary.trade.instructions) {
    bars.push_back(report::histogram(entry.times_s, 0, high, bins));
    for (const double count : bars.back().heights) tallest = std::max(tallest, count);
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const auto& entry = summary.trade.instructions[i];
    bars[i].series = static_cast<int>(i);
    Chart panel;
    panel.title = entry.instruction;
    panel.x = {words("figure.response_time"), 0, high};
    panel.y = {words("figure.trials"), 0, tallest * 1.12, AxisScale::linear, true};
    panel.layers.push_back(bars[i]);
    if (entry.times)
      panel.layers.push_back(Rule{
          Rule::Direction::vertical, entry.times->median_s,
          words("figure.median",
                in_digits(entry.times->median_s, entry.median_s ? &entry.median_s->interval : nullptr))});
    figure.charts.push_back(std::move(panel));
  }
  figure.caption = of_trials(summary.data, all.size()) + " " + words("figure.caption_times");
  return figure;
}

std::optional<Figure> quantile_probability_figure(const Summary& summary) {
  Figure figure;
  figure.title = "Quantiles of response times, observed and predicted";
  figure.caption = of_answers(summary) +
                   " Quantiles of the response times over the probability of the answer: right answers on "
                   "the right, wrong "
                   "ones on the left. Markers: observed, with 95 % intervals (from one order statistic to "
                   "another). Lines: "
                   "the fitted diffusion model.";
  std::vector<double> times{0};
  for (const auto& entry : summary.trade.instructions) {
    if (!entry.check) continue;
    Chart chart{entry.instruction, {}, {}, {}};
    for (std::size_t q = 0; q < analysis::kPredictedQuantiles.size(); ++q) {
      Points points;
      std::vector<std::pair<double, double>> predicted;
      for (const auto& difficulty : entry.check->difficulties)
        for (const auto* answers : {&difficulty.right, &difficulty.wrong}) {
          predicted.emplace_back(answers->probability, answers->quantile_s[q]);
          const int answered = difficulty.right.observed + difficulty.wrong.observed;
          if (answers->observed_quantiles.empty() || answered == 0) continue;
          const auto& observed = answers->observed_quantiles[q];
          points.add(static_cast<double>(answers->observed) / answered, observed.value, observed.interval.low,
                     observed.interval.high);
          times.push_back(observed.interval.high);
        }
      std::sort(predicted.begin(), predicted.end());
      Line line;
      for (const auto& [probability, time_s] : predicted)
        line.x.push_back(probability), line.y.push_back(time_s);
      points.series = line.series = static_cast<int>(q);
      points.name = line.name = "quantile " + core::number(analysis::kPredictedQuantiles[q], 2);
      chart.layers.push_back(line);
      if (!points.x.empty()) chart.layers.push_back(points);
    }
    figure.charts.push_back(std::move(chart));
  }
  if (figure.charts.empty()) return std::nullopt;
  for (auto& chart : figure.charts) {
    chart.beside = false;  // a marker off its probability would look like a misfit
    chart.x = {"Probability of answer (0 to 1)", -0.03, 1.03};
    chart.y = report::fitted("Response time (s)", times, 0.06);
  }
  return on_page(std::move(figure), 300);
}

namespace {

/// Where the person could move by changing nothing but the boundary: accuracy over the mean time of right
/// answers up to `latest_s`, with the fitted drifts and the fitted time outside the decision, averaged over
/// the conditions.
Line boundary_curve(const Summary& summary, const std::string& name, double latest_s) {
  constexpr double s2 = analysis::kDiffusionScale * analysis::kDiffusionScale;
  struct Cell {
    double drift, weight;
  };
  std::vector<Cell> cells;
  std::vector<double> outside_s;
  double widest = 0;
  for (const auto& entry : summary.trade.instructions) {
    if (!entry.boundary || !entry.nondecision_s) continue;
    outside_s.push_back(entry.nondecision_s->value);
    widest = std::max(widest, entry.boundary->value);
    for (const auto& cell : entry.cells)
      if (cell.drift) cells.push_back({cell.drift->value, static_cast<double>(cell.answered)});
  }
  Line line;
  line.series = report::kNeutral;
  line.name = name;
  for (int i = 1; i <= 80 && !cells.empty(); ++i) {
    const double boundary = 1.4 * widest * i / 80;
    double all = 0, right = 0, right_s = 0;
    for (const auto& [drift, weight] : cells) {
      const double x = drift * boundary / s2, p = 1 / (1 + std::exp(-x));
      // mean decision time of a start half-way, the same for right and wrong answers
      const double decision_s =
          std::fabs(x) < 1e-6 ? boundary * boundary / (4 * s2) : boundary / (2 * drift) * std::tanh(x / 2);
      all += weight, right += weight * p, right_s += weight * p * decision_s;
    }
    const double time_s = analysis::mean(outside_s) + right_s / right;
    if (time_s > latest_s) break;
    line.x.push_back(time_s);
    line.y.push_back(right / all);
  }
  return line;
}

/// Accuracy over time with a region of uncertainty for each condition, and the curve along which only the
/// boundary changes. Empty with one condition.
std::optional<Chart> conditions_chart(const Summary& summary, const Words& words) {
  Chart chart{words("figure.trade"), {}, {}, {}};
  std::vector<double> times_s, accuracies;
  std::vector<Layer> points;
  int series = 0;
  for (const auto& entry : summary.trade.instructions) {
    const int own = series++;
    if (!entry.proportion_correct || !entry.correct_times || entry.correct_times->count < 3) continue;
    const auto& right = *entry.correct_times;
    const auto& accuracy = *entry.proportion_correct;
    const double half_s = analysis::kZ95 * right.sd_s / std::sqrt(static_cast<double>(right.count));
    Band region;
    region.x = {right.mean_s - half_s, right.mean_s + half_s};
    region.low = {accuracy.interval.low, accuracy.interval.low};
    region.high = {accuracy.interval.high, accuracy.interval.high};
    Points point;
    point.x = {right.mean_s}, point.y = {accuracy.value};
    region.series = point.series = own;
    point.name = words(name_of(entry.instruction));
    times_s.insert(times_s.end(), region.x.begin(), region.x.end());
    accuracies.insert(accuracies.end(), {accuracy.interval.low, accuracy.interval.high});
    chart.layers.push_back(region);
    points.push_back(point);
  }
  if (points.size() < 2) return std::nullopt;
  chart.x = report::fitted(words("figure.correct_time"), times_s, 0.3);
  if (auto curve = boundary_curve(summary, words("figure.boundary_curve"), chart.x.high); !curve.x.empty())
    chart.layers.push_back(std::move(curve));
  chart.layers.insert(chart.layers.end(), points.begin(), points.end());
  chart.y = proportion_axis(words("figure.proportion", words("figure.correct")),
                            *std::min_element(accuracies.begin(), accuracies.end()));
  return chart;
}

}  // namespace

std::optional<Figure> trade_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Chart caf{words("figure.conditional"), {}, {}, {}}, cells{words("figure.equal_difficulty"), {}, {}, {}};
  std::vector<double> caf_times, cell_times, accuracies;
  int series = 0;
  // in an identification task, the level says which answer is right, not how difficult the trial is
  const bool categories = summary.data.design == Design::categories;
  for (const auto& entry : summary.trade.instructions) {
    Points bins, by_difficulty;
    Line bin_line;
    for (const auto& bin : entry.caf) {
      const auto interval = analysis::wilson(bin.correct, bin.trials);
      bins.add(bin.mean_time_s, static_cast<double>(bin.correct) / bin.trials, interval.low, interval.high);
      accuracies.push_back(interval.low);
    }
    for (const auto& cell : entry.cells) {
      if (!cell.mean_correct_s || cell.answered < kFewestOfCell || categories) continue;
      by_difficulty.add(*cell.mean_correct_s, cell.proportion_correct, cell.accuracy.low, cell.accuracy.high);
      accuracies.push_back(cell.accuracy.low);
    }
    caf_times.insert(caf_times.end(), bins.x.begin(), bins.x.end());
    cell_times.insert(cell_times.end(), by_difficulty.x.begin(), by_difficulty.x.end());
    const auto name = words(name_of(entry.instruction));
    bins.series = bin_line.series = by_difficulty.series = series++;
    bins.name = bin_line.name = by_difficulty.name = name;
    bin_line.x = bins.x, bin_line.y = bins.y;
    caf.layers.insert(caf.layers.end(), {bin_line, bins});
    // no line joins the difficulties: times do not rise in their order, so it would only zigzag
    cells.layers.push_back(by_difficulty);
  }
  if (cell_times.empty() && caf_times.empty()) return std::nullopt;
  caf.x = report::fitted(words("figure.bin_time"), caf_times, 0.12);
  cells.x = report::fitted(words("figure.correct_time"), cell_times, 0.12);
  caf.y = cells.y = proportion_axis(words("figure.proportion", words("figure.correct")),
                                    *std::min_element(accuracies.begin(), accuracies.end()));
  Figure figure;
  figure.title = "Speed and accuracy";
  figure.caption = of_answers(summary) + " " + words("figure.caption_trade");
  const auto add = [&](Chart chart, const char* caption) {
    figure.charts.push_back(std::move(chart));
    figure.caption += " " + words(caption);
  };
  if (auto conditions = conditions_chart(summary, words))
    add(std::move(*conditions), "figure.caption_conditions");
  if (!caf_times.empty()) add(std::move(caf), "figure.caption_conditional");
  if (!cell_times.empty()) add(std::move(cells), "figure.caption_cells");
  return on_page(std::move(figure), 330);
}

std::optional<Figure> macro_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Chart chart{"", {}, {}, {}};
  std::vector<double> times_s, heights{0};
  std::vector<std::pair<double, double>> joined;
  int series = 0;
  for (const auto& entry : summary.trade.instructions) {
    const int own = series++;
    if (!entry.d_prime || !entry.median_s) continue;
    const auto &time = *entry.median_s, &height = *entry.d_prime;
    const Span across{time.interval.low, time.interval.high, height.value, own, true};
    Points point;
    point.add(time.value, height.value, height.interval.low, height.interval.high);
    point.series = own;
    point.name = words(name_of(entry.instruction));
    chart.layers.insert(chart.layers.end(), {across, point});
    joined.emplace_back(time.value, height.value);
    times_s.insert(times_s.end(), {across.low, across.high});
    heights.insert(heights.end(), {height.interval.low, height.interval.high});
  }
  if (joined.size() < 2) return std::nullopt;
  std::sort(joined.begin(), joined.end());
  Line line;
  line.series = report::kNeutral;
  for (const auto& [x, y] : joined) line.x.push_back(x), line.y.push_back(y);
  chart.layers.insert(chart.layers.begin(), line);
  chart.x = report::fitted(words("figure.median_time"), times_s, 0.12);
  chart.y = report::fitted(words("figure.sensitivity"), heights, 0.08);
  Figure figure;
  figure.title = "Sensitivity against time over the conditions";
  figure.chart_width_px = 560;
  figure.caption = of_answers(summary) + " " + words("figure.caption_macro");
  figure.charts.push_back(std::move(chart));
  return figure;
}

std::optional<Figure> roc_figure(const Summary& summary) {
  if (summary.rocs.empty()) return std::nullopt;
  const Words words(summary.data.language);
  Figure figure;
  figure.title = "Receiver operating characteristic";
  figure.chart_width_px = 420, figure.chart_height_px = 420;
  std::size_t trials = 0;
  std::string last;
  for (const auto& entry : summary.rocs) {
    if (!entry.level)
      for (const auto* counts : {&entry.noise, &entry.signal})
        trials += static_cast<std::size_t>(std::accumulate(counts->begin(), counts->end(), 0));
    if (figure.charts.empty() || entry.condition != last) {
      figure.charts.push_back({entry.condition, {"False alarms", 0, 1}, {"Hits", 0, 1}, {}});
      last = entry.condition;
    }
    auto& layers = figure.charts.back().layers;
    Line line;
    Points points;
    line.series = points.series = static_cast<int>(layers.size() / 2);
    line.name = entry.level ? with_minus(core::number(*entry.level, 4)) : "all";
    for (const auto& point : entry.roc.points) {
      line.x.push_back(point.false_alarms), line.y.push_back(point.hits);
      points.x.push_back(point.false_alarms), points.y.push_back(point.hits);
    }
    layers.push_back(std::move(line));
    layers.push_back(std::move(points));
  }
  figure.caption = of_trials(summary.data, trials) + " " + words("figure.caption_roc");
  return figure;
}

std::optional<Figure> signal_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Chart chart{"", {}, {}, {}};
  std::vector<double> times{0}, heights{0};
  std::size_t trials = 0;
  int series = 0;
  for (const auto& curve : summary.curves) {
    Points points;
    Line line;
    points.series = line.series = series++;
    points.name = line.name = words(name_of(curve.condition));
    for (const auto& point : curve.points) {
      const auto& [hits, misses, false_alarms, correct_rejections] = point.counts;
      trials += static_cast<std::size_t>(hits + misses + false_alarms + correct_rejections);
      if (!point.d_prime) continue;
      const auto& interval = point.d_prime->interval;
      points.add(point.time_s, point.d_prime->value, interval.low, interval.high);
      times.push_back(point.time_s);
      heights.insert(heights.end(), {interval.low, interval.high});
    }
    const double last_s = *std::max_element(times.begin(), times.end());
    if (curve.asymptote && curve.rate_per_s && curve.intercept_s)
      for (int i = 0; i <= 200; ++i) {
        line.x.push_back(1.05 * last_s * i / 200);
        line.y.push_back(analysis::d_prime_at(curve.asymptote->value, curve.rate_per_s->value,
                                              curve.intercept_s->value, line.x.back()));
      }
    if (!line.x.empty()) chart.layers.push_back(line);
    chart.layers.push_back(points);
  }
  if (times.size() < 2) return std::nullopt;
  chart.x = report::fitted("Time from response zero to the answer (s)", times, 0.06);
  chart.y = report::fitted(words("figure.sensitivity"), heights, 0.08);
  Figure figure;
  figure.title = "Sensitivity over time";
  figure.chart_width_px = 560;
  figure.caption = of_trials(summary.data, trials) + " " + words("figure.caption_signal");
  figure.charts.push_back(std::move(chart));
  return figure;
}

}  // namespace turnpoint::report
