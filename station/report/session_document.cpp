#include <algorithm>
#include <cmath>

#include "station/analysis/proportion.hpp"
#include "station/core/number.hpp"
#include "station/report/document.hpp"
#include "station/report/figures.hpp"
#include "station/report/measures.hpp"

namespace turnpoint::report {

namespace {

using analysis::Estimate;
using core::phrase, core::plain;
using Look = Text::Look;

Cell level_cell(const std::optional<double>& level) { return amount(level, 4, "all"); }

Text right_of(const analysis::Proportion& right) {
  return Text(phrase("report.of", {plain(right.right), plain(right.trials)})) + ", " +
         Number{right.value, right.interval};
}

Cell proportion_cell(const std::optional<analysis::Proportion>& right) {
  if (!right) return {"not scored", Cell::Kind::missing};
  return count(right_of(*right));
}

// --- psychometric functions, and what procedures estimated themselves

void add_fit(const NamedFit& named, const SessionData& session, Document& document) {
  const auto& data = analysis_of(named, session);
  const auto& fit = named.fit;
  const auto& found = named.intervals;
  if (!named.name.empty()) document.heading(named.name, 3);
  if (fit.parameters) {
    const auto& p = *fit.parameters;
    Table table;
    const auto row = [&table](Text name, double value,
                              const std::optional<analysis::ParameterInterval>& interval,
                              bool is_brief = false) {
      auto cell =
          interval
              ? count(Number{value, interval->interval, 3, interval->touches_low, interval->touches_high})
              : amount(value);
      cell.brief = is_brief;
      table.rows.push_back({std::move(name), std::move(cell)});
    };
    const bool two_sided = data.design == Design::two_sided;
    row(threshold_label(data), p.threshold, found.threshold, true);
    row(slope_label(fit.options.function, data), p.slope, found.slope, slope_estimated(named));
    if (!slope_estimated(named)) {
      auto& cell = table.rows.back()[1];
      cell.text = found.slope
                      ? Text("only limited ", Look::soft) +
                            Text(in_known_digits(std::get<Number>(cell.text.runs[0].what)).second, Look::soft)
                      : Text("only limited", Look::soft);
    }
    if (found.level_75 && !two_sided)
      row(in_unit(plain("75 % point"), plain(data.level_unit)), *found.level_75, found.interval_75);
    row({in_unit(phrase("report.lapse"), phrase("report.share")), Look::label}, p.lapse, found.lapse, true);
    if (found.guess)
      row(has_noise(data.design) ? "False alarms (proportion)" : "Guess rate (proportion)", p.guess,
          found.guess);
    if (found.method != analysis::IntervalMethod::posterior) row("Deviance (no unit)", fit.deviance, {});
    if (found.deviance_p)
      row("Share of bootstrap replicates with a worse fit (proportion)", *found.deviance_p, {});
    document.table(std::move(table));
  }
  if (auto how = describe_intervals(named, session); !how.empty())
    document.parts.push_back(Paragraph{std::move(how), true, true});
  document.remark(fit.statements);
  document.remark(found.statements);
}

void add_fits(const Summary& summary, Document& document) {
  if (summary.fits.empty()) return;
  document.heading(phrase("report.psychometric"));
  document.figure("psychometric-function", psychometric_figure(summary));
  for (const auto& named : summary.fits) add_fit(named, summary.data, document);
}

void add_estimates(const Summary& summary, Document& document) {
  const auto& data = summary.data;
  if (data.estimates.empty() && data.early_ends.empty()) return;
  document.heading(phrase("report.own_estimate"));
  for (const auto& end : data.early_ends) document.parts.push_back(Paragraph{early_end(end), false, true});
  std::vector<OwnEstimate> estimates;
  for (const auto& estimate : data.estimates) {
    // the fit has the others
    const auto& name = estimate.parameter;
    const bool more = summary.fits.empty() || name == "criterion" || name == "gradient" || name == "floor";
    estimates.push_back({{}, estimate, more && estimate.interval});
  }
  add_own_estimates({}, estimates, data.thresholds_differ, document);
}

void add_threshold_curves(const Summary& summary, Document& document) {
  const auto& data = summary.data;
  if (data.threshold_curves.empty()) return;
  document.heading("Threshold along the second dimension");
  document.figure("threshold-curve", threshold_curve_figure(summary));
  for (const auto& curve : data.threshold_curves) {
    Table table{{curve.label, Text("Threshold, ") + data.level_label}, {}};
    for (const auto& point : curve.points)
      table.rows.push_back({amount(point.second, 4), estimated(point.threshold, point.interval)});
    document.table(std::move(table));
  }
  document.explain(
      "Means and central 95 % credible intervals of the procedure's posterior, with the prior and the grid "
      "of the protocol. All answers determine the threshold at each place, because the procedure assumes "
      "that it changes by its gradient.");
}

// --- settings, ratings and numbers

void add_settings(const Summary& summary, Document& document) {
  const auto& data = summary.data;
  document.heading(phrase("report.settings"));
  document.figure("settings", settings_figure(summary));
  if (summary.settings.empty()) return document.remark(phrase("statement.no_settings"));
  for (const auto& settings : summary.settings) {
    Table table;
    const auto row = [&](Text name, const std::optional<Estimate>& value, bool is_brief = false) {
      table.rows.push_back({std::move(name), estimated(value)});
      table.rows.back()[1].brief = is_brief;
    };
    document.heading(settings.procedure + (settings.condition.empty() ? "" : ", " + settings.condition), 3);
    table.rows.push_back({"Settings", count(static_cast<int>(settings.values.size()))});
    const auto in_its_unit = [&](core::Phrase name) {
      return in_unit(std::move(name), plain(data.level_unit));
    };
    row(in_its_unit(phrase("report.mean_setting")), settings.mean, true);
    row({in_its_unit(phrase("report.spread_sd")), Look::label}, settings.sd, true);
    if (settings.from_below.settings > 0 && settings.from_above.settings > 0) {
      for (const auto& [name, side] :
           {std::pair("from below", &settings.from_below), std::pair("from above", &settings.from_above)}) {
        const auto counted = std::string(", ") + name + " (" + std::to_string(side->settings) + " settings)";
        row(in_its_unit(plain("Mean")) + counted, side->mean);
        row(in_its_unit(plain("Spread")) + counted, side->sd);
      }
      row(in_its_unit(plain("Mean from below \u2212 mean from above")), settings.side_difference);
    }
    row("Influence of the starting position (0: none, 1: full)", settings.start_slope);
    document.table(std::move(table));
    document.remark(settings.statements);
  }
  document.explain("95 % intervals: Student's t (Welch's for the difference), chi squared.");
}

void add_judgements(const Summary& summary, Document& document) {
  const bool numbers = summary.data.design == Design::numbers;
  document.heading(phrase(numbers ? "report.magnitudes" : "report.ratings"));
  document.figure("judgements", judgement_figure(summary));
  for (const auto& judged : summary.judgements) {
    if (!judged.condition.empty()) document.heading(judged.condition, 3);
    Table table{{summary.data.level_label, "Answers", numbers ? "Geometric mean" : "Mean", "Median"}, {}};
    for (const auto& level : judged.levels)
      table.rows.push_back({amount(level.level, 4), count(static_cast<int>(level.values.size())),
                            brief(estimated(level.mean)), amount(level.median)});
    if (!table.rows.empty() && numbers)
      document.table(
          {{}, {{Text(phrase("report.exponent"), Look::label), brief(estimated(judged.exponent))}}});
    document.table(std::move(table));
    document.remark(judged.statements);
  }
  document.explain(numbers ? "95 % intervals: Student's t of the logarithms. The exponent is the slope of "
                             "log number over log level (Stevens\u2019 law)."
                           : "95 % intervals: Student's t.");
}

Text share_of(double p, int sessions) {
  return Text("p = ") + Text(Number{p}) + " (" + std::to_string(sessions) + " simulated sessions)";
}

void add_scales(const Summary& summary, Document& document) {
  const auto& data = summary.data;
  const bool pairs = data.design == Design::pairs;
  document.heading(phrase("report.scale"));
  document.figure("scale", scale_figure(summary));
  for (const auto& scale : summary.scales) {
    if (!scale.condition.empty()) document.heading(scale.condition, 3);
    Table table{{data.level_label, place_label(scale.model)}, {}};
    if (pairs) table.columns.emplace_back("Chosen");
    for (std::size_t i = 0; scale.fit && i < scale.stimuli.size(); ++i) {
      table.rows.push_back({amount(scale.stimuli[i], 4), brief(estimated(scale.fit->values[i]))});
      if (pairs)
        table.rows.back().push_back(
            count(std::to_string(scale.chosen[i]) + " / " + std::to_string(scale.presented[i])));
    }
    if (!table.rows.empty()) document.table(std::move(table));
    Table facts;
    const auto& fit = scale.fit;
    if (fit && fit->noise)
      facts.rows.push_back({"Noise of a comparison (1: the whole scale)", estimated(fit->noise)});
    if (fit && fit->favours_second)
      facts.rows.push_back(
          {std::string("Tendency to answer \u201csecond\u201d (") + tendency_unit(scale.model) + ")",
           estimated(fit->favours_second)});
    if (fit && scale.check) {
      facts.rows.push_back({"Deviance (degrees of freedom)",
                            Text(Number{fit->deviance}) + " (" + std::to_string(fit->degrees) + "), " +
                                share_of(scale.check->deviance_p, scale.check->sessions)});
      if (!pairs)
        facts.rows.push_back({"Runs of answers", Text(std::to_string(scale.check->runs)) + ", " +
                                                     share_of(scale.check->runs_p, scale.check->sessions)});
      if (const auto& p = scale.check->six_points_p)
        facts.rows.push_back({"Answers that the six-point property restricts",
                              Text(std::to_string(scale.check->six_points) + " sets, ") +
                                  share_of(*p, scale.check->sessions)});
    }
    if (const auto& triples = scale.transitivity; triples && triples->triples > 0) {
      facts.rows.push_back({"Circular triples", count(std::to_string(triples->circular) + " / " +
                                                      std::to_string(triples->triples))});
      facts.rows.push_back(
          {"Triples without moderate, without strong transitivity",
           count(std::to_string(triples->moderate) + ", " + std::to_string(triples->strong))});
      if (triples->consistence)
        facts.rows.push_back({"Consistence (Kendall)", amount(*triples->consistence)});
    }
    if (!facts.rows.empty()) document.table(std::move(facts));
    document.remark(scale.statements);
  }
  document.explain(
      pairs ? "The mean of all values is 0. Bradley and Terry: a difference is the logarithm of the odds of "
              "a choice; Thurstone: it is a d\u2032. 95 % intervals: profile likelihood with Jeffreys\u2019 "
              "prior."
            : "The scale runs from 0 at the first stimulus to 1 at the last. 95 % intervals: profile "
              "likelihood with Jeffreys\u2019 prior. Few runs mean that the scale has the wrong shape, or "
              "that some answers were given without attention.");
}

// --- answers by stimulus, and sensitivity

void add_confusions(const Summary& summary, Document& document) {
  if (summary.confusions.empty()) return;
  const auto& data = summary.data;
  const auto quoted = [](const std::string& choice) { return "\u201c" + choice + "\u201d"; };
  document.heading(phrase("report.answers"));
  document.figure("answers-to-each-stimulus", confusion_figure(summary));
  for (const auto& confusion : summary.confusions) {
    if (!confusion.condition.empty()) document.heading(confusion.condition, 3);
    if (confusion.rows.empty()) {
      document.remark(phrase("statement.none_answered"));
      continue;
    }
    Table table{{data.scored ? Text("Right answer") : Text(data.level_label)}, {}};
    for (const auto& choice : data.choices) table.columns.emplace_back(quoted(choice));
    table.columns.emplace_back(phrase("report.proportion_right"), true);
    for (const auto& row : confusion.rows) {
      auto& cells = table.rows.emplace_back();
      cells.push_back(row.stimulus ? Cell(quoted(data.choices.at(static_cast<std::size_t>(*row.stimulus))))
                                   : amount(row.level, 4, "none"));
      for (const int answers : row.answers)
        cells.push_back(count(answers)), cells.back().shade = 1.0 * answers / row.trials;
      cells.push_back(proportion_cell(row.right));
      cells.back().brief = row.stimulus && row.right;
    }
    if (confusion.right) {
      table.rows.push_back({head("All"), proportion_cell(confusion.right)});
      table.rows.back()[0].columns = static_cast<int>(data.choices.size()) + 1;
    }
    document.table(std::move(table));
  }
  document.explain("Number of trials with each answer. 95 % intervals: Clopper and Pearson.");
}

void add_detections(const Summary& summary, Document& document) {
  if (summary.detections.empty()) return;
  const auto& data = summary.data;
  document.heading("Sensitivity and criterion");
  Table table{{"Condition",
               data.cut != 0 ? Text("Distance from " + core::number(data.cut, 6)) : Text(data.level_label),
               "Hits", "False alarms", "d\u2032 (standard deviations)", "Criterion c (standard deviations)"},
              {}};
  const auto of = [](int some, int others) {
    return count(std::to_string(some) + " / " + std::to_string(some + others));
  };
  for (const auto& entry : summary.detections) {
    const auto& n = entry.counts;
    table.rows.push_back({name_of(entry.condition), level_cell(entry.level), of(n.hits, n.misses),
                          of(n.false_alarms, n.correct_rejections), estimated(entry.d_prime),
                          estimated(entry.criterion)});
  }
  document.table(std::move(table));
  const auto yes = static_cast<std::size_t>(data.design == Design::yes_no ? data.positive : 1);
  document.explain(
      "A hit is the answer \u201c" + (yes < data.choices.size() ? data.choices[yes] : "second") +
      "\u201d in a trial in which this answer is right. A false alarm is the same answer in a trial in which "
      "it is wrong. A positive criterion means that the participant avoids this answer. Rates have the "
      "log-linear correction; 95 % intervals are those of Gourevitch and Galanter.");
}

void add_rocs(const Summary& summary, Document& document) {
  if (summary.rocs.empty()) return;
  const auto& level = summary.data.level_label;
  const auto unequal = Text("d") + Text("a", Look::below);
  document.heading(phrase("report.roc_curve"));
  document.figure("roc", roc_figure(summary));
  Table table{{"Condition", level, "Area under the curve", "d\u2032, equal variances",
               unequal + ", unequal variances", "SD with a signal"},
              {}};
  Table criteria{
      {"Condition", level,
       "Criteria between ratings that were given (equal variances; SDs above the mean without a signal)"},
      {}};
  const auto of = [](const std::optional<analysis::RatingFit>& fit, Estimate analysis::RatingFit::*value) {
    return estimated(fit ? std::optional((*fit).*value) : std::nullopt);
  };
  for (const auto& entry : summary.rocs) {
    const auto name = name_of(entry.condition);
    table.rows.push_back({name, level_cell(entry.level), estimated(entry.roc.area),
                          of(entry.equal, &analysis::RatingFit::sensitivity),
                          of(entry.unequal, &analysis::RatingFit::sensitivity),
                          of(entry.unequal, &analysis::RatingFit::sd)});
    if (!entry.equal) continue;
    Text list;
    for (const double criterion : entry.equal->criteria)
      list += (list.runs.empty() ? "" : ", ") + Text(Number{criterion});
    criteria.rows.push_back({name, level_cell(entry.level), std::move(list)});
  }
  document.table(std::move(table));
  document.table(std::move(criteria));
  document.explain(
      Text(summary.data.design == Design::ratings
               ? "Ratings go from the surest no to the surest yes."
               : "Answer and confidence together are a rating, from the surest no to the surest yes.") +
      " Each point counts the trials that are rated at least so high: hits with a signal, false alarms "
      "without one. An area of 0.5 is chance. The area is that under straight lines, which is a little "
      "smaller than under a smooth curve; its 95 % interval is that of Newcombe (2006, method 5). d\u2032 "
      "and " +
      unequal +
      " are maximum likelihood fits of normal distributions, without and with a standard deviation of its "
      "own for trials with a signal (1 is that of trials without); their intervals follow from the expected "
      "information. They are left out where the answers do not determine them.");
}

const char* explanation(analysis::Deciding model) {
  switch (model) {
    case analysis::Deciding::largest:
      return "d\u2032 of an observer who chooses the interval with the largest of independent observations. ";
    case analysis::Deciding::independent:
      return "Independent observations: A and B are compared, and X is classified by a criterion. ";
    case analysis::Deciding::differencing:
      break;
  }
  return "Differencing: the answer is A or B, whichever is nearer to X. ";
}

void add_discriminations(const Summary& summary, Document& document) {
  if (summary.discriminations.empty()) return;
  document.heading("Sensitivity");
  Table table{{"Condition", summary.data.level_label, "Proportion correct"}, {}};
  std::string models;
  for (const auto model : summary.data.deciding) {
    table.columns.emplace_back(std::string("d\u2032, ") + analysis::name(model) + " (standard deviations)");
    models += explanation(model);
  }
  for (const auto& entry : summary.discriminations) {
    auto& cells = table.rows.emplace_back();
    cells = {name_of(entry.condition), level_cell(entry.level), proportion_cell(entry.right)};
    for (const auto& [model, estimate] : entry.d_primes)
      cells.push_back(count(Number{estimate.value, estimate.interval, 3, false, false, true}));
  }
  document.table(std::move(table));
  document.explain(
      models +
      "No preference for an answer is assumed. 95 % intervals: Clopper and Pearson for the proportion "
      "correct, with both ends converted to d\u2032. The value itself has the log-linear correction.");
}

// --- accuracy at the response signal

void add_curve_differences(const Summary& summary, Document& document) {
  Table table{{"Difference", "Asymptote (d\u2032)", "Ratio of rates (no unit)", "Intercept (s)",
               "p if only the asymptote is shared", "rate shared", "intercept shared"},
              {}};
  for (const auto& pair : summary.curve_differences) {
    auto& cells = table.rows.emplace_back();
    cells = {second_minus_first(pair.first, pair.second), estimated(pair.asymptote),
             estimated(pair.rate_ratio), estimated(pair.intercept_s)};
    for (std::size_t i = 0; i < pair.p.size(); ++i) {
      cells.push_back(amount(pair.p[i]));
      if (pair.corrected_p[i]) cells.back().text += ", corrected " + Text(Number{*pair.corrected_p[i]});
    }
  }
  document.table(std::move(table));
}

void add_signal(const Summary& summary, Document& document) {
  if (summary.curves.empty()) return;
  document.heading(phrase("report.signal_accuracy"));
  document.figure("response-signal", signal_figure(summary));
  Table curves{{"Condition", "Asymptote (d\u2032)", "Rate (1/s)", "Intercept (s)"}, {}};
  Table lags{
      {"Condition", "Signal after (s)", "Mean response time (s)", "Trials", "d\u2032 (standard deviations)"},
      {}};
  Table levels{{"Condition", "Signal after (s)", Text(summary.data.level_label) + ", without sign",
                "d\u2032 (standard deviations)"},
               {}};
  for (const auto& curve : summary.curves) {
    const auto name = name_of(curve.condition);
    curves.rows.push_back(
        {name, estimated(curve.asymptote), estimated(curve.rate_per_s), estimated(curve.intercept_s)});
    for (const auto& point : curve.points) {
      const auto& n = point.counts;
      lags.rows.push_back({name, amount(point.lag_s), amount(point.time_s),
                           count(n.hits + n.misses + n.false_alarms + n.correct_rejections),
                           estimated(point.d_prime)});
    }
    for (std::size_t i = 0; i < curve.by_level.size(); ++i)
      for (const auto& level : curve.by_level[i])
        levels.rows.push_back(
            {name, amount(curve.points[i].lag_s), amount(level.level.value_or(0)), estimated(level.d_prime)});
  }
  document.table(std::move(curves));
  add_curve_differences(summary, document);
  for (const auto& curve : summary.curves) document.remark(curve.statements);
  document.table(std::move(lags));
  document.table(std::move(levels));
  document.explain(
      "Only answers within the window after the signal are used. The curve is d\u2032(t) = asymptote (1 "
      "\u2212 exp(\u2212rate (t \u2212 intercept))); t is the mean response time at a lag, so it includes "
      "the time that people need to answer the signal. Each lag has its own criterion. The values are the "
      "most probable ones, with 95 % profile intervals. Priors: the asymptote is half-normal with a standard "
      "deviation of 1.8; the rate is log-normal around 3 per second, with a standard deviation of 1.5 in its "
      "natural logarithm; the intercept is uniform up to the longest mean response time. With few trials a "
      "rate is drawn towards 3 per second. An end that the answers do not determine is named as such. The p "
      "values compare the model in which both conditions share one parameter with two curves of their own "
      "(chi squared, one degree of freedom). d\u2032 at each lag has the log-linear correction and the "
      "interval of Gourevitch and Galanter.");
}

// --- speed and accuracy

bool has(const Measure<Result>& row, const Summary& summary) {
  const auto& conditions = summary.trade.instructions;
  if (row.value == &Result::d_prime)
    return std::any_of(conditions.begin(), conditions.end(), [](const auto& one) { return one.d_prime; });
  return *row.part == '\0' || shows(summary.data, row.part);
}

/// A table with a row for each measure and a column for each condition.
template <class Condition>
Table table_of(const std::vector<Condition>& conditions, std::string Condition::*name) {
  Table table{{""}, {}};
  for (const auto& entry : conditions)
    table.columns.push_back({name_of(entry.*name), !(entry.*name).empty()});
  return table;
}
template <class Condition>
std::vector<Cell> row_of(const Measure<Condition>& measure, const std::vector<Condition>& conditions) {
  std::vector<Cell> cells{head(phrase(measure.title))};
  for (const auto& entry : conditions) {
    cells.push_back(estimated(entry.*measure.value));
    cells.back().brief = measure.brief;
  }
  return cells;
}

void add_instructions(const Summary& summary, Document& document) {
  const auto& conditions = summary.trade.instructions;
  auto table = table_of(conditions, &Result::instruction);
  for (const auto& row : kSpeedAndAccuracy)
    if (has(row, summary)) table.rows.push_back(row_of(row, conditions));
  std::vector<Cell> deadlines{head("Deadline (s)")}, trials{head("Trials presented / timed out / excluded")};
  for (const auto& entry : conditions) {
    deadlines.push_back(amount(entry.deadline_s));
    trials.push_back(count(std::to_string(entry.presented) + " / " + std::to_string(entry.timeouts) + " / " +
                           std::to_string(entry.excluded)));
  }
  table.rows.push_back(std::move(deadlines));
  table.rows.push_back(std::move(trials));
  document.table(std::move(table));
}

/// A difference with its interval and, if the protocol asks for it, its corrected p value.
Cell difference_cell(const analysis::Difference& difference) {
  auto cell = estimated(difference.estimate);
  cell.brief = difference.estimate.has_value();
  if (difference.corrected_p)
    cell.text += Text("; p = ", Look::soft) + Text(core::number(*difference.corrected_p, 2), Look::soft);
  return cell;
}

/// A table with one column for each pair of conditions.
void add_differences(const Summary& summary, Document& document) {
  const auto& differences = summary.trade.differences;
  std::vector<std::pair<std::string, std::string>> pairs;
  const auto pair_of = [](const analysis::Difference& one) { return std::pair(one.first, one.second); };
  for (const auto& one : differences)
    if (std::find(pairs.begin(), pairs.end(), pair_of(one)) == pairs.end()) pairs.push_back(pair_of(one));
  Table table{{"Difference"}, {}};
  for (const auto& [first, second] : pairs)
    table.columns.push_back({second_minus_first(first, second), true});
  if (pairs.empty()) return;
  for (const auto& row : kSpeedAndAccuracy) {
    if (!has(row, summary) || !row.compared) continue;
    auto& cells = table.rows.emplace_back();
    cells.push_back(head(phrase(row.title)));
    for (const auto& pair : pairs) {
      const auto found = std::find_if(differences.begin(), differences.end(), [&](const auto& one) {
        return one.measure == row.name && pair_of(one) == pair;
      });
      cells.push_back(found == differences.end() ? estimated(std::nullopt) : difference_cell(*found));
    }
  }
  document.table(std::move(table));
}

const char* compared(protocol::Holm holm) {
  return holm == protocol::Holm::all ? "all differences between conditions in this report"
                                     : "pairs of conditions that a measure compares";
}

/// Conditional accuracy in each bin of time, and its differences between conditions.
void add_conditional(const Summary& summary, Document& document) {
  std::size_t bins = 0;
  for (const auto& entry : summary.trade.instructions) bins = std::max(bins, entry.caf.size());
  Table table{{"Conditional accuracy: bin of time", "Condition", "Mean time (s)",
               Column(phrase("report.proportion_right"), true)},
              {}};
  for (std::size_t i = 0; i < bins; ++i) {
    const auto of = phrase("report.bin", {plain(i + 1), plain(bins)});
    for (const auto& entry : summary.trade.instructions) {
      if (i >= entry.caf.size()) continue;
      const auto& bin = entry.caf[i];
      table.rows.push_back({of, name_of(entry.instruction), amount(bin.mean_time_s),
                            estimated(static_cast<double>(bin.correct) / bin.trials,
                                      analysis::wilson(bin.correct, bin.trials))});
    }
    for (const auto& one : summary.trade.differences)
      if (one.measure == analysis::kBinMeasure + std::to_string(i + 1) + " of " + std::to_string(bins))
        table.rows.push_back({of, second_minus_first(one.first, one.second), "", difference_cell(one)});
  }
  document.table(std::move(table));
}

void add_difficulties(const Summary& summary, Document& document) {
  const bool drift = shows(summary.data, "ez");
  Table table{{"Condition", "Difficulty (as " + Text("difficulty", Look::code) + " or the size of the level)",
               "Correct (trials, proportion)", "Mean correct (s)"},
              {}};
  if (drift) table.columns.emplace_back("Drift v (1/s, s = 0.1)");
  for (const auto& entry : summary.trade.instructions)
    for (const auto& part : entry.cells) {
      auto& cells = table.rows.emplace_back();
      cells = {name_of(entry.instruction), amount(part.difficulty, 4),
               count(Text(part.correct) + " / " + part.answered + ", " +
                     Number{part.proportion_correct, part.accuracy}),
               amount(part.mean_correct_s, 3, "none")};
      if (drift) cells.push_back(estimated(part.drift));
    }
  if (table.rows.empty()) return document.remark(phrase("statement.no_right_answer"));
  document.table(std::move(table));
}

/// What the trade was, in one paragraph for each pair of conditions: how much later answers came, how much
/// more often they were right, and what of it the diffusion model ascribes to caution and to the quality of
/// the evidence.
void add_trade_in_words(const Summary& summary, Document& document) {
  const auto& differences = summary.trade.differences;
  const auto of = [&](const analysis::Difference& pair, const char* measure) -> const analysis::Difference* {
    for (const auto& one : differences)
      if (one.first == pair.first && one.second == pair.second && one.measure == measure && one.estimate)
        return &one;
    return nullptr;
  };
  const auto change = [](const analysis::Difference& gap, const char* lower, const char* higher) {
    const bool detected = gap.corrected_p ? *gap.corrected_p < 0.05
                                          : gap.estimate->interval.low > 0 || gap.estimate->interval.high < 0;
    return !detected ? "did not change detectably" : gap.estimate->value < 0 ? lower : higher;
  };
  const auto size = [](Estimate gap, double scale) {
    if (gap.value < 0) gap = {-gap.value, {-gap.interval.high, -gap.interval.low, gap.interval.confidence}};
    return Number{scale * gap.value, analysis::Interval{scale * gap.interval.low, scale * gap.interval.high,
                                                        gap.interval.confidence}};
  };
  for (const auto& pair : differences) {
    if (pair.measure != analysis::kCorrect) continue;
    const auto *right = of(pair, analysis::kCorrect), *time = of(pair, analysis::kMedianTime);
    if (right == nullptr || time == nullptr) continue;
    auto text = "Compared with " + Text(name_of(pair.first), Look::strong) + ", answers under " +
                Text(name_of(pair.second), Look::strong) + " came " + size(*time->estimate, 1) + " s " +
                (time->estimate->value < 0 ? "sooner" : "later") + " (median) and were right " +
                size(*right->estimate, 100) + " % of the trials " +
                (right->estimate->value < 0 ? "less" : "more") + " often.";
    const auto *boundary = of(pair, analysis::kBoundary), *drift = of(pair, analysis::kDrift);
    if (boundary != nullptr && drift != nullptr)
      text += std::string(" The boundary ") +
              change(*boundary, "was lower (less caution)", "was higher (more caution)") + "; the drift " +
              change(*drift, "was lower (weaker evidence)", "was higher (stronger evidence)") + ".";
    document.say(std::move(text));
  }
}

/// Whether the diffusion model describes the answers: a sentence, the observed and the predicted quantiles,
/// and a table of what it predicts.
void add_model(const Summary& summary, Document& document) {
  const auto& trade = summary.trade;
  if (!trade.model_p) return;
  document.heading("Does the diffusion model describe these answers?", 3);
  const auto percent = core::number(100 * *trade.model_p, 2);
  document.say(
      *trade.model_p < 0.05
          ? "No: only " + percent +
                " % of sessions that follow the fitted model are as far from it as this one. Boundary, drift "
                "and time outside the decision may mislead here."
          : "Yes, as far as these answers can tell: " + percent +
                " % of sessions that follow the fitted model are as far from it as this one, or farther.");
  document.figure("quantiles", quantile_probability_figure(summary));
  Table table{{"Condition", "Difficulty", "Right, observed (proportion of answers)", "Right, predicted",
               "Mean time of right answers, observed (s)", "predicted (s)",
               "Mean time of wrong answers, observed (s)", "predicted (s)"},
              {}};
  const auto part = [](double some, double whole) {
    return amount(whole > 0 ? std::optional(some / whole) : std::nullopt, 3, "none");
  };
  const auto time = [](const std::optional<double>& mean_s) { return amount(mean_s, 3, "none"); };
  for (const auto& entry : trade.instructions) {
    if (!entry.check) continue;
    for (std::size_t i = 0; i < entry.check->difficulties.size(); ++i) {
      const auto& [right, wrong] = entry.check->difficulties[i];
      table.rows.push_back(
          {name_of(entry.instruction),
           i < entry.difficulties.size() ? amount(entry.difficulties[i], 4) : count(static_cast<int>(i + 1)),
           part(right.observed, right.observed + wrong.observed),
           part(right.probability, right.probability + wrong.probability), time(right.observed_mean_s),
           time(right.mean_s), time(wrong.observed_mean_s), time(wrong.mean_s)});
    }
  }
  document.table(std::move(table));
}

void add_trade(const Summary& summary, Document& document) {
  const auto& trade = summary.trade;
  const auto& data = summary.data;
  if (trade.instructions.empty() || !data.scored) return;
  document.heading(phrase("report.speed_accuracy"));
  add_trade_in_words(summary, document);
  document.figure("speed-accuracy", trade_figure(summary));
  document.figure("sensitivity-over-conditions", macro_figure(summary));
  add_instructions(summary, document);
  add_differences(summary, document);
  if (data.holm != protocol::Holm::none)
    document.explain(std::string("p values are corrected by Holm\u2019s method for the number of ") +
                     compared(data.holm) + ", as the protocol asks (holm). Intervals are not corrected.");
  add_conditional(summary, document);
  document.figure("response-times", response_time_figure(summary));
  if (data.design != Design::categories) add_difficulties(summary, document);
  if (shows(data, "ez"))
    document.explain(
        "Boundary, time outside the decision and drift come from the diffusion model, fitted to all answers, "
        "with those that came too late as decisions not made by the deadline. Times that the exclusion rule "
        "leaves out elsewhere are part of this fit: trimming would change the distribution that is fitted. "
        "The numbers are medians of the posterior distribution, with 95 % intervals.");
  for (const auto& [part, what, more] :
       {std::tuple("lisas", "LISAS", ""),
        {"ies", "The inverse efficiency score",
         ", and suits few errors only, up to 10 % (Bruyer & Brysbaert 2011)"}})
    if (shows(data, part))
      document.explain(std::string(what) +
                       " combines speed and accuracy, but is not free of the trade-off itself: it can change "
                       "when only the boundary does (Liesefeld & Janczyk 2019)" +
                       more + ". Do not read its differences as differences of ability.");
  for (const auto& entry : trade.instructions) document.remark(entry.statements, entry.instruction);
  document.remark(trade.statements);
  add_model(summary, document);
}

// --- the trial before, the session and the finger

/// What one regression of the trial before describes, and in which units.
std::string before_in_words(const analysis::Dependence& one) {
  using analysis::Answers;
  const auto quoted = [](const std::string& words) { return "\u201c" + words + "\u201d"; };
  const std::string per = one.unit.empty() ? "unit of the level" : one.unit;
  std::string words = one.analysis.empty() ? "" : one.analysis + ": ";
  switch (one.how.answers) {
    case Answers::logarithms:
      return words + "slopes of the logarithm of the number over those of stimulus and number in the trial " +
             "before, with a mean of its own for each level" +
             (one.how.decibel ? "; decibels count as ratios." : ".");
    case Answers::values:
      return words + "slopes of the rating over stimulus (per " + per +
             ") and rating of the trial before, with a mean of its own for each level.";
    case Answers::settings:
      return words +
             "slopes of the setting over the slider\u2019s start, and over start and setting of the " +
             "trial before, with a mean of its own for each condition.";
    case Answers::sides:
    case Answers::choices:
      break;
  }
  words += "logistic regression on the stimulus and on the trial before, in log odds of the answer " +
           quoted(one.answer) + ". A stimulus counts " +
           (one.how.decibel ? std::string("as a ratio (1 for 0 dB)") : "per " + per);
  if (one.how.answers == Answers::sides)
    words += ", positive if " + quoted(one.answer) + " is right";
  else if (one.how.noise)
    words += ", and is 0 unless " + quoted(one.answer) + " is right";
  return words + ".";
}

/// The effects of the trial before; only for tasks whose answers can be described by them.
void add_before(const Summary& summary, Document& document) {
  const auto& entries = summary.dependences;
  if (entries.empty()) return;
  document.heading(phrase("report.trial_before"));
  document.figure("trial-before", before_figure(summary));
  auto table = table_of(entries, &analysis::Dependence::condition);
  for (const auto& row : kBefore)
    if (std::any_of(entries.begin(), entries.end(), [&](const auto& one) { return one.*row.value; }))
      table.rows.push_back(row_of(row, entries));
  if (table.rows.empty()) {
    for (const auto& entry : entries) document.remark(entry.statements, entry.condition);
    return;
  }
  auto& pairs = table.rows.emplace_back();
  pairs.push_back(head("Pairs of trials"));
  for (const auto& entry : entries) pairs.push_back(count(entry.pairs));
  document.table(std::move(table));
  for (const auto& entry : entries) document.remark(entry.statements, entry.condition);
  std::vector<std::string> regressions;  // several conditions have the same
  for (const auto& entry : entries) {
    auto words = before_in_words(entry);
    if (entry.analysis.empty()) words[0] = static_cast<char>(words[0] - 'a' + 'A');
    if (std::ranges::find(regressions, words) == regressions.end()) regressions.push_back(std::move(words));
  }
  for (const auto& words : regressions) document.explain(words);
  const bool logistic = std::ranges::any_of(entries, [](const auto& one) { return !one.answer.empty(); });
  const bool after =
      std::ranges::any_of(entries, [](const auto& one) { return one.after_error.has_value(); });
  document.explain(
      std::string(logistic ? "The answer before is above 0 for people who repeat themselves, and below 0 for "
                             "those who alternate. "
                           : "") +
      (after
           ? "After an error: what the stimulus weighs more than after a right answer, whatever the answers "
             "shift then. "
           : "") +
      "Pairs are answered trials " + (summary.data.parts.empty() ? "" : "of the same analysis ") +
      "that follow each other in a block. " +
      (logistic ? "Penalised likelihood (Firth 1993) with 95 % profile intervals."
                : "95 % intervals: Student\u2019s t."));
}

void add_course(const Summary& summary, Document& document) {
  document.heading(phrase("report.course"));
  Table table;
  const auto line = [&table](Text name, Text value, bool is_brief = true) {
    table.rows.push_back({head(std::move(name)), std::move(value)});
    table.rows.back()[1].brief = is_brief;
  };
  const auto trend = [&](const char* name, const std::optional<analysis::Trend>& found, const char* unit) {
    line(name,
         found ? Number{found->per_100_trials, found->interval} + Text(unit) + " per 100 trials"
               : "too few trials",
         false);
  };
  const auto& counts = summary.outcomes;
  line(phrase("report.presented"), counts.presented);
  line(phrase("report.answered"), counts.answered);
  line(phrase("report.late_early"),
       std::to_string(counts.timeouts) + ", " + std::to_string(counts.anticipations));
  line(phrase("report.void"), counts.aborted + counts.faults);
  if (counts.aborted > 0) line("of these, aborted", counts.aborted, false);
  if (summary.data.unsure)
    line("Unsure",
         std::to_string(counts.unsure) + " of " + std::to_string(counts.answered) +
             " answers; they are left out of proportions correct and response times, and count as " +
             core::number(1.0 / summary.data.alternatives, 3) +
             " of a right answer in the psychometric function",
         false);
  for (const auto& [degree, right] : summary.confidence)
    line("Right with confidence " + std::to_string(degree), right_of(right), false);
  if (summary.catch_trials) line(phrase("report.catch_right"), right_of(*summary.catch_trials));
  if (const auto& bias = summary.bias; bias && summary.data.choices.size() > 1)
    line(phrase("report.chose", {plain(summary.data.choices[1])}),
         Number{100 * bias->share_second,
                analysis::Interval{100 * bias->interval.low, 100 * bias->interval.high}} +
             Text(" %") +
             (bias->criterion
                  ? ", " + Text(phrase("report.criterion")) + " c = " + Number{*bias->criterion, {}, 2}
                  : Text()));
  trend("Trend of response time", summary.fatigue.response_time_s, " s");
  if (summary.data.scored && summary.data.design != Design::adjustment)
    trend("Trend of accuracy", summary.fatigue.proportion_correct, " (proportion correct)");
  document.table(std::move(table));
  document.explain(
      "Trials of practice are left out. Void trials are those that were aborted or had a fault.");
  document.figure("levels", trace_figure(summary));
  if (summary.bias) document.remark(summary.bias->statements);
  document.remark(summary.fatigue.statements);
}

void add_finger_conditions(const analysis::Finger& finger, Document& document) {
  auto table = table_of(finger.conditions, &Touched::condition);
  for (const auto& row : kFinger) table.rows.push_back(row_of(row, finger.conditions));
  auto& cells = table.rows.emplace_back();
  cells.push_back(head("Trials recorded / with known forces / with a felt boundary"));
  for (const auto& condition : finger.conditions)
    cells.push_back(count(std::to_string(condition.trials) + " / " + std::to_string(condition.measured) +
                          " / " + std::to_string(condition.felt)));
  document.table(std::move(table));
}

void add_finger(const Summary& summary, Document& document) {
  if (!summary.finger) return;
  document.heading(phrase("report.finger"));
  add_finger_conditions(*summary.finger, document);
  document.figure("finger", finger_figure(summary));
  document.remark(summary.finger->statements);
  if (auto friction = friction_figure(summary)) {
    document.figure("friction", std::move(friction));
    document.explain(
        "All conditions together. Filled markers: means of 3 or more trials at one planned boundary. Open "
        "markers: single trials, side by side if they have the same boundary. The felt boundary is where "
        "friction changed under the finger; the planned one is the place that the scene\u2019s " +
        Text("edge", Look::code) + " names. They should agree for an edge that friction defines, " +
        Text("{ friction = \u2026 }", Look::code) +
        "; other edges are defined at other places. Along the strip: means of the strokes in bins of 2 mm, "
        "with bars of one standard error, where 3 or more strokes were made.");
  }
  Table repeats{{"Level", "Presented", "Presented again because of the movement"}, {}};
  for (const auto& at : summary.data.repeats)
    repeats.rows.push_back({head(at.level ? core::number(*at.level, 4) : "none"), count(at.presented),
                            count(std::to_string(at.repeated) + " (" +
                                  core::number(std::round(100.0 * at.repeated / at.presented), 3) + " %)")});
  if (!repeats.rows.empty()) {
    document.table(std::move(repeats));
    document.explain(
        "If some levels are repeated more often than others, the trials that count are a selection.");
  }
  document.explain(
      "Answered trials without practice. Force and speed are means over a trial\u2019s strokes; with more "
      "than 40 trials, a marker is the mean of several trials, with a bar from the smallest to the largest. "
      "Friction is lateral force divided by normal force, in the scene presented last. 95 % intervals: "
      "Student\u2019s t over trials; for a single trial, 1.96 standard errors.");
}

/// Friction that was asked for and felt under the finger, and whether the surface followed it.
void add_following(const Summary& summary, Document& document) {
  const auto& conditions = summary.followed;
  if (conditions.empty()) return;
  document.heading(phrase("report.following"));
  document.figure("friction-over-place", followed_figure(summary));
  document.figure("felt-minus-asked", deviation_figure(summary));
  if (summary.data.followed_places.empty())
    document.remark(plain(
        "Friction over place is not drawn: nowhere did a sliding finger feel a scene that asks for friction "
        "in 3 or more intervals. A finger that presses without sliding feels no friction."));
  else if (asked_differs(summary))
    document.remark(plain(
        "What was asked for at one place differs between the intervals of a scene, because a factor changes "
        "or moves it: the medians of asked and felt friction are then not what any interval presented. "
        "Compare felt minus asked friction, or the trials in the signal \u201cfollow\u201d."));
  auto table = table_of(conditions, &Following::condition);
  for (const auto& row : kFollowing) table.rows.push_back(row_of(row, conditions));
  auto& cells = table.rows.emplace_back();
  cells.push_back(head("Trials recorded / without a fault of following"));
  for (const auto& entry : conditions)
    cells.push_back(count(std::to_string(entry.trials) + " / " + std::to_string(entry.faultless)));
  document.table(std::move(table));
  if (std::ranges::any_of(conditions, [](const auto& entry) { return entry.trials < 3; }))
    document.remark(plain("With fewer than 3 trials, a condition has no means."));
  document.explain(
      "Answered trials without practice. The table is about the interval presented last, the figure about "
      "all "
      "intervals. Friction is measured only while the finger slides, and each measurement is compared with "
      "what was asked at the place and time at which it was made, in places of 1 mm, where 3 or more "
      "intervals "
      "have one. Commanded is what the friction table and the modelled vibration make of what was asked. If "
      "the protocol does not state the friction of the surface at rest (" +
      Text("resting_friction", Look::code) +
      "), asked and commanded friction are scaled in each interval so that commanded and felt have the same "
      "mean: only the variation is then compared, not the height. Error and lag of the envelope are what "
      "pick-ups say. 95 % intervals: Student\u2019s t over trials; for shares on the logit scale.");
}

void add_station(const SessionData& data, Document& document) {
  if (data.health.empty()) return;
  document.heading(phrase("report.station"));
  document.facts(data.health);
}

}  // namespace

Document document(const std::vector<Summary>& of_tasks) {
  auto whole = document(of_tasks.front());
  if (of_tasks.size() == 1) return whole;
  Document all = whole;
  all.parts.clear();
  all.facts(of_tasks.front().data.facts);
  for (const auto& summary : of_tasks)
    for (auto& part : document(summary).parts) all.parts.push_back(std::move(part));
  add_station(of_tasks.front().data, all);
  return all;
}

Document document(const Summary& summary) {
  const auto& data = summary.data;
  Document document;
  document.title = data.title;
  document.name = data.title + ", " + data.participant;
  document.run_mode = data.run_mode;
  document.language = data.language;
  document.about = "Participant " + Text(data.participant, Look::strong) + ", session " + data.session_id +
                   ", " + data.status;
  if (data.task.empty()) document.facts(data.facts);
  if (!data.task.empty()) document.heading(Text(phrase("design.keys.task"), Look::label) + ": " + data.task);
  add_meanings(data, document);
  if (judges(data.design)) {
    add_judgements(summary, document);
    add_rocs(summary, document);
  } else if (scales(data.design)) {
    add_scales(summary, document);
    add_trade(summary, document);
  } else if (data.design == Design::adjustment) {
    add_settings(summary, document);
  } else {
    add_fits(summary, document);
    add_threshold_curves(summary, document);
    add_confusions(summary, document);
    add_estimates(summary, document);
    add_detections(summary, document);
    add_rocs(summary, document);
    add_discriminations(summary, document);
    add_signal(summary, document);
    add_trade(summary, document);
  }
  add_before(summary, document);
  add_course(summary, document);
  add_finger(summary, document);
  add_following(summary, document);
  if (!data.measured.empty()) {
    document.heading("Vibration of the surface");
    document.explain("Open markers: void, because the vibration was too far from the plan.");
    document.figure("vibration", vibration_figure(summary));
  }
  if (data.task.empty()) add_station(data, document);
  for (auto& part : document.parts)
    if (auto* figure = std::get_if<NamedFigure>(&part); figure && !data.task.empty())
      figure->name = data.task + "-" + figure->name;
  return document;
}

}  // namespace turnpoint::report
