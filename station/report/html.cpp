#include "station/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "station/analysis/proportion.hpp"
#include "station/core/number.hpp"
#include "station/report/figures.hpp"
#include "station/report/html_choices.hpp"
#include "station/report/html_parts.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {

using analysis::Estimate;

std::string row(const std::string& name, double value,
                const std::optional<analysis::ParameterInterval>& interval, bool limited = false) {
  const double error =
      interval ? core::uncertainty(value, interval->interval.low, interval->interval.high) : 0;
  const auto shown = [error](double number) { return minus(core::estimated(number, error)); };
  std::string html = "<tr><td>" + escaped(name) + "</td><td class=\"n\">";
  html += limited ? "<span class=\"soft\">only limited</span>" : shown(value);
  if (interval) {
    html += " <span class=\"soft\">[" + std::string(interval->touches_low ? "\u2264 " : "") +
            shown(interval->interval.low) + ", " + (interval->touches_high ? "\u2265 " : "") +
            shown(interval->interval.high) + "]</span>";
  }
  return html + "</td></tr>";
}

std::string in_unit(const std::string& name, const LevelAnalysis& data) {
  return name + " (" + (data.level_unit.empty() ? "no unit" : data.level_unit) + ")";
}

std::string slope_name(const NamedFit& named, const LevelAnalysis& data) {
  switch (named.fit.options.function) {
    case core::Function::normal:
      return in_unit("Spread, standard deviation", data);
    case core::Function::logistic:
      return data.level_unit.empty() ? "Slope (no unit)" : "Slope (1/" + data.level_unit + ")";
    case core::Function::weibull:
      break;
  }
  return "Slope (exponent, no unit)";
}

std::string fit_table(const NamedFit& named, const SessionData& session) {
  const auto& data = analysis_of(named, session);
  std::string html;
  if (!named.name.empty()) html += "<h3>" + escaped(named.name) + "</h3>\n";
  if (named.fit.parameters) {
    const auto& p = *named.fit.parameters;
    const auto& found = named.intervals;
    const bool posterior = found.method == analysis::IntervalMethod::posterior;
    const bool two_sided = data.design == Design::two_sided;
    html += "<table>" + row(in_unit(two_sided ? "PSE" : "Threshold", data), p.threshold, found.threshold);
    html += row(slope_name(named, data), p.slope, found.slope, !slope_estimated(named));
    if (found.level_75 && !two_sided)
      html += row(in_unit("75 % point", data), *found.level_75, found.interval_75);
    html += row("Lapse rate (proportion)", p.lapse, found.lapse);
    if (found.guess)
      html += row(has_noise(data.design) ? "False alarms (proportion)" : "Guess rate (proportion)", p.guess,
                  found.guess);
    if (!posterior) html += row("Deviance (no unit)", named.fit.deviance, std::nullopt);
    if (found.deviance_p)
      html +=
          row("Share of bootstrap replicates with a worse fit (proportion)", *found.deviance_p, std::nullopt);
    html += "</table>\n";
  }
  if (const auto text = core::say(describe_intervals(named, session), "en"); !text.empty())
    html += "<p class=\"soft\">" + escaped(text) + "</p>\n";
  return html + notes(named.fit.statements) + notes(named.intervals.statements);
}

/// Returns table rows with the settings, separately for sliders that started from below and from above.
std::string side_rows(const analysis::Settings& settings, const SessionData& data) {
  std::string html;
  for (const auto& [name, side] :
       {std::pair("from below", &settings.from_below), std::pair("from above", &settings.from_above)}) {
    const auto counted = std::string(", ") + name + " (" + std::to_string(side->settings) + " settings)";
    html += "<tr><td>" + escaped(in_unit("Mean", data) + counted) + "</td>" + cell(side->mean) + "</tr>";
    html += "<tr><td>" + escaped(in_unit("Scatter", data) + counted) + "</td>" + cell(side->sd) + "</tr>";
  }
  return html + "<tr><td>" + escaped(in_unit("Mean from below \u2212 mean from above", data)) + "</td>" +
         cell(settings.side_difference) + "</tr>";
}

std::string settings_section(const Summary& summary) {
  std::string html = "<h2>Settings</h2>\n" + picture(settings_figure(summary));
  if (summary.settings.empty())
    return html + "<p class=\"note\">There are no settings in this session.</p>\n";
  for (const auto& settings : summary.settings) {
    const auto name = settings.procedure + (settings.condition.empty() ? "" : ", " + settings.condition);
    html += "<table><tr><th>" + escaped(name) + "</th><td class=\"n\">" +
            std::to_string(settings.values.size()) + " settings</td></tr>";
    html += "<tr><td>" + escaped(in_unit("Mean, point of subjective equality", summary.data)) + "</td>" +
            cell(settings.mean) + "</tr>";
    html += "<tr><td>" + escaped(in_unit("Scatter, standard deviation", summary.data)) + "</td>" +
            cell(settings.sd) + "</tr>";
    if (settings.from_below.settings > 0 && settings.from_above.settings > 0)
      html += side_rows(settings, summary.data);
    html += "<tr><td>Influence of the starting position (0: none, 1: full)</td>" +
            cell(settings.start_slope) + "</tr></table>\n" + notes(settings.statements);
  }
  return html +
         "<p class=\"soft\">95 % intervals: Student's t (Welch's for the difference), chi squared.</p>\n";
}

std::string judgement_section(const Summary& summary) {
  const bool numbers = summary.data.design == Design::numbers;
  const std::string mean = numbers ? "Geometric mean" : "Mean";
  std::string html = std::string("<h2>") + (numbers ? "Numbers" : "Ratings") + "</h2>\n" +
                     picture(judgement_figure(summary));
  for (const auto& judged : summary.judgements) {
    if (!judged.condition.empty()) html += "<h3>" + escaped(judged.condition) + "</h3>\n";
    if (judged.levels.empty()) {
      html += notes(judged.statements);
      continue;
    }
    html += "<table><tr><th>" + escaped(summary.data.level_label) + "</th><th>Answers</th><th>" + mean +
            "</th><th>Median</th></tr>";
    for (const auto& level : judged.levels)
      html += "<tr><td class=\"n\">" + number(level.level, 4) + "</td><td class=\"n\">" +
              std::to_string(level.values.size()) + "</td>" + cell(level.mean) + "<td class=\"n\">" +
              number(level.median) + "</td></tr>";
    html += "</table>\n";
    if (numbers)
      html += "<table><tr><td>Exponent of Stevens\u2019 law (no unit)</td>" + cell(judged.exponent) +
              "</tr></table>\n";
    html += notes(judged.statements);
  }
  html += std::string("<p class=\"soft\">95 % intervals: Student's t") +
          (numbers ? " of the logarithms. The exponent is the slope of log number over log level." : ".") +
          "</p>\n";
  return html;
}

/// A row of the table of speed and accuracy. The row appears only if the protocol shows the part of the
/// report that `part` names, and that of points only if the protocol gives points.
struct MeasureRow {
  const char *title, *measure, *part;
  std::optional<Estimate> analysis::InstructionResult::*value;
};
using Result = analysis::InstructionResult;
constexpr MeasureRow kRows[] = {
    {"Proportion correct (0 to 1)", "proportion correct", "", &Result::proportion_correct},
    {"Median response time (s)", "median response time", "", &Result::median_s},
    {"Sensitivity d\u2032 over all levels (standard deviations)", "d'", "d'", &Result::d_prime},
    {"Boundary a (diffusion, s = 0.1)", "boundary", "ez", &Result::boundary},
    {"Time outside the decision Ter (s)", "time outside the decision", "ez", &Result::nondecision_s},
    {"Drift v, mean over difficulties (1/s, s = 0.1)", "drift", "ez", &Result::drift},
    {"Share of trials that were no decision (0 to 1)", "", "ez", &Result::contaminants},
    {"LISAS (s)", "LISAS", "lisas", &Result::lisas_s},
    {"Inverse efficiency (s)", "inverse efficiency", "ies", &Result::inverse_efficiency_s},
    {"Points a trial", "points a trial", "points", &Result::points},
    {"Points a minute, of trials with their pauses", "points a minute", "points", &Result::points_per_minute},
    {"Slower after an error than before it (s)", "", "", &Result::post_error_s},
    {"Answers that repeat the last answer, more than right ones would (share)", "", "", &Result::repetition},
    {"Boundary, second half of the blocks \u2212 first half (s = 0.1)", "", "ez", &Result::late_boundary}};

bool has(const MeasureRow& row, const Summary& summary) {
  const auto& conditions = summary.trade.instructions;
  if (row.value == &Result::d_prime)
    return std::any_of(conditions.begin(), conditions.end(), [](const auto& one) { return one.d_prime; });
  if (row.part == std::string("points")) return summary.data.payoff;
  return *row.part == '\0' || shows(summary.data, row.part);
}

std::string instruction_table(const Summary& summary) {
  const auto& trade = summary.trade;
  std::string html = "<table><tr><th></th>";
  for (const auto& entry : trade.instructions) html += "<th>" + escaped(name_of(entry.instruction)) + "</th>";
  html += "</tr>";
  for (const auto& row : kRows) {
    if (!has(row, summary)) continue;
    html += std::string("<tr><th>") + row.title + "</th>";
    for (const auto& entry : trade.instructions) html += cell(entry.*row.value);
    html += "</tr>";
  }
  html += "<tr><th>Deadline (s)</th>";
  for (const auto& entry : trade.instructions)
    html += "<td class=\"n\">" + (entry.deadline_s ? number(*entry.deadline_s) : std::string("\u2013")) + "</td>";
  html += "</tr><tr><th>Trials presented / timed out / excluded</th>";
  for (const auto& entry : trade.instructions)
    html += "<td class=\"n\">" + std::to_string(entry.presented) + " / " + std::to_string(entry.timeouts) +
            " / " + std::to_string(entry.excluded) + "</td>";
  return html + "</tr></table>\n";
}

/// A difference with its interval and, if the protocol asks for it, its corrected p value.
std::string difference_cell(const analysis::Difference& difference) {
  auto html = cell(difference.estimate);
  if (difference.corrected_p)
    html.insert(html.rfind("</td>"), "<br><span class=\"soft\">p = " + number(*difference.corrected_p, 2) + "</span>");
  return html;
}

/// Conditional accuracy in each bin of time, and its differences between conditions; "" without bins.
std::string conditional_table(const Summary& summary) {
  std::size_t bins = 0;
  for (const auto& entry : summary.trade.instructions) bins = std::max(bins, entry.caf.size());
  if (bins == 0) return "";
  std::string html =
      "<table><tr><th>Conditional accuracy: bin of time</th><th>Condition</th><th>Mean time (s)</th>"
      "<th>Proportion correct (0 to 1)</th></tr>";
  for (std::size_t i = 0; i < bins; ++i) {
    const auto of = std::to_string(i + 1) + " of " + std::to_string(bins);
    for (const auto& entry : summary.trade.instructions) {
      if (i >= entry.caf.size()) continue;
      const auto& bin = entry.caf[i];
      html += "<tr><td>" + of + "</td><td>" + escaped(name_of(entry.instruction)) + "</td><td class=\"n\">" +
              number(bin.mean_time_s) + "</td><td class=\"n\">" +
              estimated(static_cast<double>(bin.correct) / bin.trials,
                        analysis::wilson(bin.correct, bin.trials)) +
              "</td></tr>";
    }
    for (const auto& difference : summary.trade.differences)
      if (difference.measure == analysis::kBinMeasure + of)
        html += "<tr><td>" + of + "</td><td>" + escaped(name_of(difference.second)) + " \u2212 " +
                escaped(name_of(difference.first)) + "</td><td></td>" + difference_cell(difference) + "</tr>";
  }
  return html + "</table>\n";
}

/// Says which comparisons were corrected for their number; "" if none were.
std::string correction_note(const SessionData& data) {
  if (data.holm == protocol::Holm::none) return "";
  return std::string("<p class=\"soft\">p values are corrected by Holm\u2019s method for the number of ") +
         (data.holm == protocol::Holm::all ? "all differences between conditions in this report"
                                           : "pairs of conditions that a measure compares") +
         ", as the protocol asks (holm). Intervals are not corrected.</p>\n";
}

/// Returns a table with one column for each pair of conditions.
std::string difference_table(const Summary& summary) {
  const auto& differences = summary.trade.differences;
  if (differences.empty()) return "";
  std::vector<std::string> pairs;
  const auto pair_of = [](const analysis::Difference& difference) {
    return name_of(difference.second) + " \u2212 " + name_of(difference.first);
  };
  for (const auto& difference : differences)
    if (std::find(pairs.begin(), pairs.end(), pair_of(difference)) == pairs.end())
      pairs.push_back(pair_of(difference));
  std::string html = "<table><tr><th>Difference</th>";
  for (const auto& pair : pairs) html += "<th>" + escaped(pair) + "</th>";
  html += "</tr>";
  for (const auto& row : kRows) {
    if (!has(row, summary) || *row.measure == '\0') continue;
    html += std::string("<tr><th>") + row.title + "</th>";
    for (const auto& pair : pairs)
      for (const auto& difference : differences)
        if (difference.measure == row.measure && pair_of(difference) == pair)
          html += difference_cell(difference);
    html += "</tr>";
  }
  return html + "</table>\n";
}

std::string difficulty_table(const Summary& summary) {
  const bool drift = shows(summary.data, "ez");
  if (std::all_of(summary.trade.instructions.begin(), summary.trade.instructions.end(),
                  [](const auto& entry) { return entry.cells.empty(); }))
    return "<p class=\"note\">No answered trial has a right answer, so there is no table by "
           "difficulty.</p>\n";
  std::string html =
      "<table><tr><th>Condition</th><th>Difficulty (as <code>difficulty</code> or the size of the "
      "level)</th><th>Correct (trials, proportion)</th><th>Mean correct (s)</th>";
  html += std::string(drift ? "<th>Drift v (1/s, s = 0.1)</th>" : "") + "</tr>";
  for (const auto& entry : summary.trade.instructions)
    for (const auto& part : entry.cells) {
      html += "<tr><td>" + escaped(name_of(entry.instruction)) + "</td><td class=\"n\">" +
              number(part.difficulty, 4) + "</td><td class=\"n\">" + std::to_string(part.correct) + " / " +
              std::to_string(part.answered) + ", " + estimated(part.proportion_correct, part.accuracy) +
              "</td><td class=\"n\">" + (part.mean_correct_s ? number(*part.mean_correct_s) : "none") +
              "</td>";
      if (drift) html += cell(part.drift);
      html += "</tr>";
    }
  return html + "</table>\n";
}

/// What the trade was, in one sentence for each pair of conditions: how much later answers came, how much
/// more often they were right, and what of it the diffusion model ascribes to caution and to the quality of
/// the evidence.
std::string trade_sentences(const Summary& summary) {
  const auto& differences = summary.trade.differences;
  const auto named = [&](const analysis::Difference& pair, const char* measure) -> const analysis::Difference* {
    for (const auto& one : differences)
      if (one.first == pair.first && one.second == pair.second && one.measure == measure && one.estimate)
        return &one;
    return nullptr;
  };
  const auto find = [&](const analysis::Difference& pair, const char* measure) -> const Estimate* {
    const auto* one = named(pair, measure);
    return one == nullptr ? nullptr : &*one->estimate;
  };
  const auto detected = [](const analysis::Difference& gap) {
    if (gap.corrected_p) return *gap.corrected_p < 0.05;
    return gap.estimate->interval.low > 0 || gap.estimate->interval.high < 0;
  };
  const auto size = [](Estimate gap, double scale, const char* unit) {
    if (gap.value < 0) gap = {-gap.value, {-gap.interval.high, -gap.interval.low, gap.interval.confidence}};
    const analysis::Interval scaled{scale * gap.interval.low, scale * gap.interval.high,
                                    gap.interval.confidence};
    return estimated(scale * gap.value, scaled) + unit;
  };
  std::string html;
  for (const auto& pair : differences) {
    if (pair.measure != "proportion correct") continue;
    const auto *right = find(pair, "proportion correct"), *time = find(pair, "median response time");
    if (right == nullptr || time == nullptr) continue;
    html += "<p>Compared with <b>" + escaped(name_of(pair.first)) + "</b>, answers under <b>" +
            escaped(name_of(pair.second)) + "</b> came " + size(*time, 1, " s ") +
            (time->value < 0 ? "sooner" : "later") + " (median) and were right " +
            size(*right, 100, " % of the trials ") + (right->value < 0 ? "less" : "more") + " often.";
    const auto *boundary = named(pair, "boundary"), *drift = named(pair, "drift");
    if (boundary != nullptr && drift != nullptr)
      html += std::string(" The boundary ") +
              (!detected(*boundary)  ? "did not change detectably"
               : boundary->estimate->value < 0 ? "was lower (less caution)"
                                     : "was higher (more caution)") +
              "; the drift " +
              (!detected(*drift)  ? "did not change detectably"
               : drift->estimate->value < 0 ? "was lower (weaker evidence)"
                                  : "was higher (stronger evidence)") +
              ".";
    html += "</p>\n";
  }
  return html;
}

/// Whether the diffusion model describes the answers: a sentence, the observed and the predicted quantiles,
/// and a table of what it predicts.
std::string model_section(const Summary& summary) {
  const auto& trade = summary.trade;
  if (!trade.model_p) return "";
  std::string html = "<h3>Does the diffusion model describe these answers?</h3>\n<p>";
  html += *trade.model_p < 0.05
              ? "No: only " + number(100 * *trade.model_p, 2) +
                    " % of sessions that follow the fitted model are as far from it as this one. Boundary, "
                    "drift and time outside the decision may mislead here."
              : "Yes, as far as these answers can tell: " + number(100 * *trade.model_p, 2) +
                    " % of sessions that follow the fitted model are as far from it as this one, or farther.";
  html += "</p>\n" + picture(quantile_probability_figure(summary)) +
          "<table><tr><th>Condition</th><th>Difficulty</th><th>Right, observed (proportion of answers)</th>"
          "<th>Right, predicted</th><th>Mean time of right answers, observed (s)</th><th>predicted (s)</th>"
          "<th>Mean time of wrong answers, observed (s)</th><th>predicted (s)</th></tr>";
  const auto time = [](const std::optional<double>& mean_s) {
    return "<td class=\"n\">" + (mean_s ? number(*mean_s) : std::string("none")) + "</td>";
  };
  for (const auto& entry : trade.instructions) {
    if (!entry.check) continue;
    for (std::size_t i = 0; i < entry.check->difficulties.size(); ++i) {
      const auto& [right, wrong] = entry.check->difficulties[i];
      const double answered = right.observed + wrong.observed, whole = right.probability + wrong.probability;
      html += "<tr><td>" + escaped(name_of(entry.instruction)) + "</td><td class=\"n\">" +
              (i < entry.difficulties.size() ? number(entry.difficulties[i], 4) : std::to_string(i + 1)) +
              "</td>" + time(answered > 0 ? std::optional(right.observed / answered) : std::nullopt) +
              time(whole > 0 ? std::optional(right.probability / whole) : std::nullopt) +
              time(right.observed_mean_s) + time(right.mean_s) + time(wrong.observed_mean_s) +
              time(wrong.mean_s) + "</tr>";
    }
  }
  return html + "</table>\n";
}

std::string trade_section(const Summary& summary) {
  if (summary.trade.instructions.empty() || !summary.data.scored) return "";
  const bool several = summary.trade.instructions.size() > 1;
  std::string html = several ? "<h2>Speed-accuracy trade-off</h2>\n" : "<h2>Speed and accuracy</h2>\n";
  html += trade_sentences(summary) + picture(trade_figure(summary)) + picture(macro_figure(summary)) +
          instruction_table(summary) + difference_table(summary) + correction_note(summary.data) +
          conditional_table(summary) + picture(response_time_figure(summary));
  if (summary.data.design != Design::categories) html += difficulty_table(summary);
  if (shows(summary.data, "ez"))
    html +=
        "<p class=\"soft\">Boundary, time outside the decision and drift come from the diffusion model, "
        "fitted to all "
        "answers, with those that came too late as decisions not made by the deadline. Times that the "
        "exclusion rule "
        "leaves out elsewhere are part of this fit: trimming would change the distribution that is fitted. "
        "The numbers "
        "are medians of the posterior distribution, with 95 % intervals.</p>\n";
  html += model_section(summary);
  for (const auto& [part, name] : {std::pair("lisas", "LISAS"), {"ies", "The inverse efficiency score"}})
    if (shows(summary.data, part))
      html += std::string("<p class=\"soft\">") + name +
              " combines speed and accuracy, but is not free of the trade-off itself: it can change when "
              "only the "
              "boundary does (Liesefeld &amp; Janczyk 2019)" +
              (std::string(part) == "ies"
                   ? ", and suits few errors only, up to 10 % (Bruyer &amp; Brysbaert 2011)"
                   : "") +
              ". Do not read its differences as differences of ability.</p>\n";
  for (const auto& entry : summary.trade.instructions) {
    for (auto statement : entry.statements) {
      if (!entry.instruction.empty())
        statement.text = {"", "", {core::plain(entry.instruction + ": "), statement.text}};
      html += notes({statement});
    }
  }
  return html + notes(summary.trade.statements);
}

std::string detection_section(const Summary& summary) {
  if (summary.detections.empty()) return "";
  const auto& data = summary.data;
  std::string html =
      "<h2>Sensitivity and criterion</h2>\n<table><tr><th>Condition</th><th>" +
      escaped(data.cut != 0 ? "Distance from " + core::number(data.cut, 6) : data.level_label) +
      "</th><th>Hits</th><th>False alarms</th><th>d\u2032 (standard deviations)</th>"
      "<th>Criterion c (standard deviations)</th></tr>";
  for (const auto& entry : summary.detections) {
    const auto& n = entry.counts;
    html += "<tr><td>" + escaped(name_of(entry.condition)) + "</td><td class=\"n\">" +
            (entry.level ? number(*entry.level, 4) : "all") + "</td><td class=\"n\">" +
            std::to_string(n.hits) + " / " + std::to_string(n.hits + n.misses) + "</td><td class=\"n\">" +
            std::to_string(n.false_alarms) + " / " + std::to_string(n.false_alarms + n.correct_rejections) +
            "</td>" + cell(entry.d_prime) + cell(entry.criterion) + "</tr>";
  }
  const auto yes = static_cast<std::size_t>(data.design == Design::yes_no ? data.positive : 1);
  const auto answer = yes < data.choices.size() ? data.choices[yes] : "second";
  return html + "</table>\n<p class=\"soft\">A hit is the answer \u201c" + escaped(answer) +
         "\u201d in a trial in which this answer is right. A false alarm is the same answer in a trial "
         "in which it is wrong. A positive criterion means that the participant avoids this answer. Rates "
         "have the log-linear correction; 95 % intervals are those of Gourevitch and Galanter.</p>\n";
}

std::string trend(const std::optional<analysis::Trend>& trend, const char* unit) {
  if (!trend) return "too few trials";
  return estimated(trend->per_100_trials, trend->interval) + unit + " per 100 trials";
}

std::string course_section(const Summary& summary) {
  std::string html = "<h2>Over the session</h2>\n<table>";
  const auto line = [&](const std::string& name, const std::string& value) {
    html += "<tr><th>" + name + "</th><td>" + value + "</td></tr>";
  };
  const auto& counts = summary.outcomes;
  line("Trials", std::to_string(counts.presented) + " presented, " + std::to_string(counts.answered) +
                     " answered, " + std::to_string(counts.timeouts) + " timeouts, " +
                     std::to_string(counts.anticipations) + " anticipations, " +
                     std::to_string(counts.aborted) + " aborted, " + std::to_string(counts.faults) +
                     " faults (practice left out)");
  if (summary.data.unsure)
    line("Unsure",
         std::to_string(counts.unsure) + " of " + std::to_string(counts.answered) +
             " answers; they are left out of proportions correct and response times, and count as " +
             number(1.0 / summary.data.alternatives, 3) + " of a right answer in the psychometric function");
  for (const auto& [degree, right] : summary.confidence)
    line("Right with confidence " + std::to_string(degree),
         std::to_string(right.right) + " of " + std::to_string(right.trials) + ", proportion " +
             estimated(right.value, right.interval));
  if (summary.catch_trials)
    line("Catch trials right", std::to_string(summary.catch_trials->right) + " of " +
                                   std::to_string(summary.catch_trials->trials) + ", proportion " +
                                   estimated(summary.catch_trials->value, summary.catch_trials->interval));
  if (summary.bias && summary.data.choices.size() > 1)
    line("Answered " + escaped("\u201c" + summary.data.choices[1] + "\u201d"),
         estimated(100 * summary.bias->share_second,
                   {100 * summary.bias->interval.low, 100 * summary.bias->interval.high, 0.95}) +
             " %" +
             (summary.bias->criterion ? ", criterion c = " + number(*summary.bias->criterion, 2) : ""));
  line("Trend of response time", trend(summary.fatigue.response_time_s, " s"));
  if (summary.data.scored && summary.data.design != Design::adjustment)
    line("Trend of accuracy", trend(summary.fatigue.proportion_correct, " (proportion correct)"));
  html += "</table>\n" + picture(trace_figure(summary));
  if (summary.bias) html += notes(summary.bias->statements);
  return html + notes(summary.fatigue.statements);
}

}  // namespace

std::string to_html(const Summary& summary) {
  const auto& data = summary.data;
  std::string html = html_head(data.title + ", " + data.participant) + "<h1>" + escaped(data.title) +
                     "</h1>\n<p>Participant <b>" + escaped(data.participant) + "</b>, session " +
                     escaped(data.session_id) + ", " + escaped(data.status);
  if (data.run_mode != "live") html += " <span class=\"mode\">" + escaped(data.run_mode) + "</span>";
  html += "</p>\n" + facts_table(data.facts) + meanings_list(data);
  if (judges(data.design)) {
    html += judgement_section(summary) + roc_section(summary);
  } else if (data.design != Design::adjustment) {
    if (!summary.fits.empty())
      html += "<h2>Psychometric function</h2>\n" + picture(psychometric_figure(summary));
    for (const auto& named : summary.fits) html += fit_table(named, data);
    html += threshold_curve_section(summary) + confusion_section(summary) + estimate_section(data) +
            detection_section(summary) + roc_section(summary) + discrimination_section(summary) +
            signal_section(summary) + trade_section(summary);
  } else {
    html += settings_section(summary);
  }
  html += course_section(summary) + finger_section(summary);
  if (!data.measured.empty())
    html +=
        "<h2>Vibration of the surface</h2>\n<p class=\"soft\">Open markers: void, because the vibration was "
        "too far from the plan.</p>\n" +
        picture(vibration_figure(summary));
  if (!data.health.empty()) html += "<h2>The station</h2>\n" + facts_table(in_english(data.health));
  return html + "</body></html>\n";
}

}  // namespace turnpoint::report
