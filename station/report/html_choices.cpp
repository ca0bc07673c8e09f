#include "station/report/html_choices.hpp"

#include <fmt/format.h>

#include <cmath>

#include "station/report/html_parts.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {

std::string quoted(const std::string& choice) { return "\u201c" + escaped(choice) + "\u201d"; }

std::string stimulus_cell(const analysis::ConfusionRow& row, const SessionData& data) {
  if (row.stimulus)
    return "<td>" + quoted(data.choices.at(static_cast<std::size_t>(*row.stimulus))) + "</td>";
  return row.level ? "<td class=\"n\">" + number(*row.level, 4) + "</td>" : "<td>none</td>";
}

/// Returns a table cell with a count. The larger the count is in relation to the row's trials, the darker is
/// its background.
std::string count_cell(int count, int trials) {
  return fmt::format("<td class=\"n\" style=\"background:rgba(0,114,178,{:.2f})\">{}</td>",
                     0.6 * count / trials, count);
}

std::string proportion_cell(const std::optional<analysis::Proportion>& right) {
  if (!right) return "<td class=\"n soft\">not scored</td>";
  return fmt::format("<td class=\"n\">{} of {}, {}</td>", right->right, right->trials,
                     estimated(right->value, right->interval));
}

}  // namespace

std::string confusion_section(const Summary& summary) {
  if (summary.confusions.empty()) return "";
  const auto& data = summary.data;
  std::string html = "<h2>Answers to each stimulus</h2>\n";
  for (const auto& confusion : summary.confusions) {
    if (!confusion.condition.empty()) html += "<h3>" + escaped(confusion.condition) + "</h3>\n";
    if (confusion.rows.empty()) {
      html += "<p class=\"note\">No trial was answered.</p>\n";
      continue;
    }
    html += "<table><tr><th>" + (data.scored ? "Right answer" : escaped(data.level_label)) + "</th>";
    for (const auto& choice : data.choices) html += "<th>" + quoted(choice) + "</th>";
    html += "<th>Proportion correct</th></tr>";
    for (const auto& row : confusion.rows) {
      html += "<tr>" + stimulus_cell(row, data);
      for (const int count : row.answers) html += count_cell(count, row.trials);
      html += proportion_cell(row.right) + "</tr>";
    }
    if (confusion.right)
      html += fmt::format("<tr><th colspan=\"{}\">All</th>", data.choices.size() + 1) +
              proportion_cell(confusion.right) + "</tr>";
    html += "</table>\n";
  }
  return html +
         "<p class=\"soft\">Number of trials with each answer. 95 % intervals: Clopper and Pearson.</p>\n";
}

namespace {

/// Returns a table cell with an estimate whose interval may have no limit at either end.
std::string open_cell(const analysis::Estimate& estimate) {
  const auto& ends = estimate.interval;
  if (std::isfinite(ends.low) && std::isfinite(ends.high)) return cell(estimate);
  const auto end = [](double value) {
    return std::isfinite(value) ? number(value) : std::string(value < 0 ? "\u2212" : "") + "\u221e";
  };
  return "<td class=\"n\">" + number(estimate.value) + " <span class=\"soft\">[" + end(ends.low) + ", " +
         end(ends.high) + "]</span></td>";
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

}  // namespace

std::string discrimination_section(const Summary& summary) {
  if (summary.discriminations.empty()) return "";
  const auto& data = summary.data;
  std::string html = "<h2>Sensitivity</h2>\n<table><tr><th>Condition</th><th>" + escaped(data.level_label) +
                     "</th><th>Proportion correct</th>",
              notes;
  for (const auto model : data.deciding) {
    html += std::string("<th>d\u2032, ") + analysis::name(model) + " (standard deviations)</th>";
    notes += explanation(model);
  }
  html += "</tr>";
  for (const auto& entry : summary.discriminations) {
    html += "<tr><td>" + (entry.condition.empty() ? "all trials" : escaped(entry.condition)) +
            "</td><td class=\"n\">" + (entry.level ? number(*entry.level, 4) : "all") + "</td>" +
            proportion_cell(entry.right);
    for (const auto& [model, estimate] : entry.d_primes) html += open_cell(estimate);
    html += "</tr>";
  }
  return html + "</table>\n<p class=\"soft\">" + notes +
         "No preference for an answer is assumed. 95 % intervals: Clopper and Pearson for the proportion "
         "correct, "
         "with both ends converted to d\u2032. The value itself has the log-linear correction.</p>\n";
}

}  // namespace turnpoint::report
