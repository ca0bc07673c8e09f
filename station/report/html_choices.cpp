#include "station/report/html_choices.hpp"

#include <fmt/format.h>

#include "station/plot/svg.hpp"
#include "station/report/html_parts.hpp"

namespace turnpoint::report {

namespace {

using plot::escaped;

std::string quoted(const std::string& choice) { return "\u201c" + escaped(choice) + "\u201d"; }

std::string stimulus_cell(const analysis::ConfusionRow& row, const SessionData& data) {
  if (row.stimulus)
    return "<td>" + quoted(data.choices.at(static_cast<std::size_t>(*row.stimulus))) + "</td>";
  return row.level ? "<td class=\"n\">" + number(*row.level, 4) + "</td>" : "<td>none</td>";
}

/// A count, on a background that is darker the larger its share of the row's trials is.
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

}  // namespace turnpoint::report
