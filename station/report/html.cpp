#include "station/report/html.hpp"

#include "station/plot/svg.hpp"
#include "station/report/figures.hpp"
#include "station/text/number.hpp"

namespace turnpoint::report {

namespace {

using analysis::Estimate;
using analysis::Interval;
using plot::escaped;

const char* const kStyle = R"(
:root{color-scheme:light}body{font:15px/1.5 Inter,"DejaVu Sans",Helvetica,Arial,sans-serif;color:#222;
max-width:860px;margin:2rem auto;padding:0 1rem}h1{font-size:1.5rem;line-height:1.25;margin:0 0 .25rem}
h2{font-size:1.1rem;margin:2rem 0 .5rem;border-bottom:1px solid #ccc;padding-bottom:.2rem}
table{border-collapse:collapse;margin:.5rem 0;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.2rem 1rem .2rem 0;vertical-align:top;border-bottom:1px solid #eee}
th{font-weight:600}td.n{text-align:right;white-space:nowrap}.note{background:#fff6e5;border-left:3px solid #e69f00;
padding:.4rem .7rem;margin:.4rem 0}.mode{display:inline-block;border:2px solid #d55e00;color:#a84600;
padding:0 .5rem;font-weight:600}.soft{color:#666}figure{margin:.5rem 0}svg{max-width:100%;height:auto}
@media print{body{margin:0;max-width:none;font-size:10pt}h2{break-after:avoid}figure,table,.note{break-inside:avoid}}
@page{size:A4;margin:16mm}
)";

std::string minus(std::string text) {
  if (!text.empty() && text[0] == '-') text = "\u2212" + text.substr(1);
  return escaped(text);
}

std::string number(double value, int digits = 3) { return minus(text::number(value, digits)); }

std::string with(const Interval& interval, int digits = 3) {
  return " <span class=\"soft\">[" + number(interval.low, digits) + ", " + number(interval.high, digits) +
         "]</span>";
}

std::string cell(const std::optional<Estimate>& estimate, int digits = 3) {
  if (!estimate) return "<td class=\"n soft\">not estimated</td>";
  return "<td class=\"n\">" + number(estimate->value, digits) + with(estimate->interval, digits) + "</td>";
}

std::string notes(const std::vector<analysis::Statement>& statements) {
  std::string html;
  for (const auto& statement : statements) html += "<p class=\"note\">" + escaped(statement.text) + "</p>\n";
  return html;
}

std::string picture(const std::optional<plot::Figure>& figure) {
  return figure ? "<figure>" + plot::render(*figure) + "</figure>\n" : "";
}

std::string facts(const std::vector<Fact>& list) {
  std::string html = "<table>";
  for (const auto& [name, value] : list)
    html += "<tr><th>" + escaped(name) + "</th><td>" + escaped(value) + "</td></tr>";
  return html + "</table>\n";
}

std::string row(const std::string& name, double value,
                const std::optional<analysis::ParameterInterval>& interval, bool limited = false) {
  std::string html = "<tr><td>" + escaped(name) + "</td><td class=\"n\">";
  html += limited ? "<span class=\"soft\">only limited</span>" : number(value, 4);
  if (interval) {
    html += " <span class=\"soft\">[" + std::string(interval->touches_low ? "\u2264 " : "") +
            number(interval->interval.low) + ", " + (interval->touches_high ? "\u2265 " : "") +
            number(interval->interval.high) + "]</span>";
  }
  return html + "</td></tr>";
}

std::string fit_table(const NamedFit& named, const SessionData& data) {
  std::string html;
  if (!named.name.empty()) html += "<h3>" + escaped(named.name) + "</h3>\n";
  if (named.fit.parameters) {
    const auto& p = *named.fit.parameters;
    const auto& found = named.intervals;
    const bool posterior = found.method == analysis::IntervalMethod::posterior;
    const bool two_sided = data.design == Design::two_sided;
    const bool spread = named.fit.options.function == analysis::Function::normal;
    html += "<table>" + row(two_sided ? "PSE" : "Threshold", p.threshold, found.threshold);
    html += row(spread ? "Spread (SD)" : "Slope", p.slope, found.slope, !slope_estimated(named));
    if (found.level_75 && !two_sided) html += row("75 % point", *found.level_75, found.interval_75);
    html += row("Lapse rate", p.lapse, found.lapse);
    if (found.guess) html += row("Guess rate", p.guess, found.guess);
    if (!posterior) html += row("Deviance", named.fit.deviance, std::nullopt);
    if (found.deviance_p) html += row("Share of replicates that fit worse", *found.deviance_p, std::nullopt);
    html += "</table>\n";
  }
  if (const auto text = describe_intervals(named, data); !text.empty())
    html += "<p class=\"soft\">" + escaped(text) + "</p>\n";
  return html + notes(named.fit.statements) + notes(named.intervals.statements);
}

std::string settings_section(const Summary& summary) {
  std::string html = "<h2>Settings</h2>\n" + picture(settings_figure(summary));
  if (summary.settings.empty()) return html + "<p class=\"note\">Nothing was set in this session.</p>\n";
  for (const auto& settings : summary.settings) {
    html += "<table><tr><th>" + escaped(settings.procedure) + "</th><td class=\"n\">" +
            std::to_string(settings.values.size()) + " settings</td></tr>";
    html += "<tr><td>Mean (point of subjective equality)</td>" + cell(settings.mean) + "</tr>";
    html += "<tr><td>Scatter (SD)</td>" + cell(settings.sd) + "</tr>";
    html += "<tr><td>Share of the start that remains</td>" + cell(settings.start_slope, 2) +
            "</tr></table>\n" + notes(settings.statements);
  }
  return html + "<p class=\"soft\">95 % intervals: Student's t, chi squared.</p>\n";
}

std::string instruction_table(const analysis::Trade& trade) {
  std::string head = "<tr><th></th>";
  for (const auto& entry : trade.instructions)
    head += "<th>" + escaped(entry.instruction.empty() ? "all trials" : entry.instruction) + "</th>";
  const bool pair = trade.differences.size() > 0;
  if (pair)
    head += "<th>" + escaped(trade.instructions[1].instruction) + " \u2212 " +
            escaped(trade.instructions[0].instruction) + "</th>";
  std::string html = "<table>" + head + "</tr>";
  const auto line = [&](const char* name, auto member, int difference) {
    html += std::string("<tr><th>") + name + "</th>";
    for (const auto& entry : trade.instructions) html += cell(entry.*member);
    if (pair) html += cell(trade.differences[static_cast<std::size_t>(difference)].estimate);
    html += "</tr>";
  };
  using Result = analysis::InstructionResult;
  line("Proportion correct", &Result::proportion_correct, 0);
  line("Median response time (s)", &Result::median_s, 1);
  line("EZ boundary a (s = 0.1)", &Result::boundary, 2);
  line("EZ time outside the decision Ter (s)", &Result::nondecision_s, 3);
  line("LISAS (s)", &Result::lisas_s, 4);
  line("Inverse efficiency (s)", &Result::inverse_efficiency_s, 5);
  line("BIS (SD over cells)", &Result::balanced, 6);
  html += "<tr><th>Trials presented / timed out / excluded</th>";
  for (const auto& entry : trade.instructions)
    html += "<td class=\"n\">" + std::to_string(entry.presented) + " / " + std::to_string(entry.timeouts) +
            " / " + std::to_string(entry.excluded) + "</td>";
  return html + (pair ? "<td></td>" : "") + "</tr></table>\n";
}

std::string trade_section(const Summary& summary) {
  if (summary.trade.instructions.empty()) return "";
  const bool two = summary.trade.instructions.size() > 1;
  std::string html = two ? "<h2>Speed and accuracy: the trade</h2>\n" : "<h2>Speed and accuracy</h2>\n";
  html += instruction_table(summary.trade) + picture(trade_figure(summary)) +
          picture(response_time_figure(summary));
  html +=
      "<table><tr><th>Instruction</th><th>Difficulty</th><th>Correct</th><th>Mean correct (s)</th>"
      "<th>Drift v</th></tr>";
  for (const auto& entry : summary.trade.instructions)
    for (const auto& part : entry.cells)
      html += "<tr><td>" + escaped(entry.instruction) + "</td><td class=\"n\">" + number(part.difficulty, 4) +
              "</td><td class=\"n\">" + std::to_string(part.correct) + " / " + std::to_string(part.answered) +
              with(part.accuracy) + "</td><td class=\"n\">" +
              (part.mean_correct_s ? number(*part.mean_correct_s) : "none") + "</td><td class=\"n\">" +
              (part.drift ? number(*part.drift) : "not estimated") + "</td></tr>";
  html += "</table>\n";
  for (const auto& entry : summary.trade.instructions) {
    for (auto statement : entry.statements) {
      if (!entry.instruction.empty()) statement.text = entry.instruction + ": " + statement.text;
      html += notes({statement});
    }
  }
  return html + notes(summary.trade.statements);
}

std::string trend(const std::optional<analysis::Trend>& trend, const char* unit) {
  if (!trend) return "too few trials";
  return number(trend->per_100_trials, 3) + unit + with(trend->interval) + " per 100 trials";
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
  if (summary.catch_trials)
    line("Catch trials right", std::to_string(summary.catch_trials->right) + " of " +
                                   std::to_string(summary.catch_trials->trials) +
                                   with(summary.catch_trials->interval));
  if (summary.bias && summary.data.choices.size() > 1)
    line("Answered " + escaped("\u201c" + summary.data.choices[1] + "\u201d"),
         number(100 * summary.bias->share_second) + " %" +
             with({100 * summary.bias->interval.low, 100 * summary.bias->interval.high, 0.95}) +
             (summary.bias->criterion ? ", criterion c = " + number(*summary.bias->criterion, 2) : ""));
  line("Trend of response time", trend(summary.fatigue.response_time_s, " s"));
  line("Trend of accuracy", trend(summary.fatigue.proportion_correct, ""));
  html += "</table>\n" + picture(trace_figure(summary));
  if (summary.bias) html += notes(summary.bias->statements);
  return html + notes(summary.fatigue.statements);
}

}  // namespace

std::string to_html(const Summary& summary) {
  const auto& data = summary.data;
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
      escaped(data.title + ", " + data.participant) + "</title>\n<style>" + kStyle +
      "</style></head><body>\n<h1>" + escaped(data.title) + "</h1>\n<p>Participant <b>" +
      escaped(data.participant) + "</b>, session " + escaped(data.session_id) + ", " + escaped(data.status);
  if (data.run_mode != "live") html += " <span class=\"mode\">" + escaped(data.run_mode) + "</span>";
  html += "</p>\n" + facts(data.facts);
  if (data.design != Design::adjustment) {
    html += "<h2>Psychometric function</h2>\n" + picture(psychometric_figure(summary));
    for (const auto& named : summary.fits) html += fit_table(named, data);
    html += trade_section(summary);
  } else {
    html += settings_section(summary);
  }
  html += course_section(summary);
  if (!data.health.empty()) html += "<h2>The station</h2>\n" + facts(data.health);
  return html + "</body></html>\n";
}

}  // namespace turnpoint::report
