#include "station/report/html_parts.hpp"

#include "station/plot/svg.hpp"
#include "station/text/number.hpp"

namespace turnpoint::report {

using analysis::Estimate;
using analysis::Interval;
using plot::escaped;

std::string minus(std::string text) {
  if (!text.empty() && text[0] == '-') text = "\u2212" + text.substr(1);
  return escaped(text);
}

std::string number(double value, int digits) { return minus(text::number(value, digits)); }

std::string estimated(double value, const Interval& interval) {
  const double error = text::uncertainty(value, interval.low, interval.high);
  const auto shown = [error](double number) { return minus(text::estimated(number, error)); };
  return shown(value) + " <span class=\"soft\">[" + shown(interval.low) + ", " + shown(interval.high) +
         "]</span>";
}

std::string cell(const std::optional<Estimate>& estimate) {
  if (!estimate) return "<td class=\"n soft\">not estimated</td>";
  return "<td class=\"n\">" + estimated(estimate->value, estimate->interval) + "</td>";
}

std::string notes(const std::vector<analysis::Statement>& statements) {
  std::string html;
  for (const auto& statement : statements) html += "<p class=\"note\">" + escaped(statement.text) + "</p>\n";
  return html;
}

std::string picture(const std::optional<plot::Figure>& figure) {
  return figure ? "<figure>" + plot::render(*figure) + "</figure>\n" : "";
}

std::string name_of(const std::string& condition) { return condition.empty() ? "all trials" : condition; }

}  // namespace turnpoint::report
