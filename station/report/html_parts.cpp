#include "station/report/html_parts.hpp"

#include <cmath>

#include "station/core/letters.hpp"
#include "station/core/number.hpp"
#include "station/report/figure_files.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

using analysis::Estimate;
using analysis::Interval;

namespace {

const char* const kStyle = R"(
:root{color-scheme:light}body{font:15px/1.5 Inter,"DejaVu Sans",Helvetica,Arial,sans-serif;color:#222;
max-width:860px;margin:2rem auto;padding:0 1rem}h1{font-size:1.5rem;line-height:1.25;margin:0 0 .25rem}
h2{font-size:1.1rem;margin:2rem 0 .5rem;border-bottom:1px solid #ccc;padding-bottom:.2rem}
table{border-collapse:collapse;margin:.5rem 0;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.2rem 1rem .2rem 0;vertical-align:top;border-bottom:1px solid #eee}
th{font-weight:600}td.n{text-align:right;white-space:nowrap}.note{background:#fff6e5;border-left:3px solid #e69f00;
padding:.4rem .7rem;margin:.4rem 0}.mode{display:inline-block;border:2px solid #d55e00;color:#a84600;
padding:0 .5rem;font-weight:600}.soft{color:#666}figure{margin:.5rem 0}svg{max-width:100%;height:auto}
.save{font-size:.8rem;margin:.1rem 0}
@media print{.save{display:none}body{margin:0;max-width:none;font-size:10pt}h2{break-after:avoid}figure,table,.note{break-inside:avoid}}
@page{size:A4;margin:16mm}
)";

std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = (three << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k < bytes.size() + 1 ? digits[(three >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

/// A link that saves a file which the page itself contains.
std::string download(const std::string& name, const std::string& type, const std::string& bytes,
                     const std::string& label) {
  return "<a download=\"" + name + "\" href=\"data:" + type + ";base64," + base64(bytes) + "\">" + label +
         "</a>";
}

}  // namespace

std::string html_head(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
         escaped(title) + "</title>\n<style>" + kStyle + "</style></head><body>\n";
}

std::string facts_table(const std::vector<Fact>& list) {
  std::string html = "<table>";
  for (const auto& [name, value] : list)
    html += "<tr><th>" + escaped(name) + "</th><td>" + escaped(value) + "</td></tr>";
  return html + "</table>\n";
}

std::string minus(std::string text) {
  if (!text.empty() && text[0] == '-') text = "\u2212" + text.substr(1);
  return escaped(text);
}

std::string number(double value, int digits) { return minus(core::number(value, digits)); }

std::string estimated(double value, const Interval& interval) {
  const double error = core::uncertainty(value, interval.low, interval.high);
  const auto shown = [error](double number) {
    return std::isfinite(number) ? minus(core::estimated(number, error)) : "not determined";
  };
  return shown(value) + " <span class=\"soft\">[" + shown(interval.low) + ", " + shown(interval.high) +
         "]</span>";
}

std::string cell(const std::optional<Estimate>& estimate) {
  if (!estimate) return "<td class=\"n soft\">not estimated</td>";
  return "<td class=\"n\">" + estimated(estimate->value, estimate->interval) + "</td>";
}

std::string notes(const std::vector<analysis::Statement>& statements) {
  std::string html;
  for (const auto& statement : statements)
    html += "<p class=\"note\">" + escaped(core::say(statement.text, "en")) + "</p>\n";
  return html;
}

std::string picture(const std::optional<Figure>& figure) {
  if (!figure) return "";
  std::string name;
  for (const char c : figure->title) {
    const char letter = core::lower(c);
    if ((letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9'))
      name += letter;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  const auto paper = [&](double width_mm) {
    Svg svg(Svg::Unit::mm);
    draw(svg, for_paper(*figure, width_mm));
    return svg.finish();
  };
  return "<figure>" + report::render(*figure) + "<p class=\"soft save\">Save: " +
         download(name + "-1-column.svg", "image/svg+xml", paper(kOneColumn_mm), "SVG, 85 mm wide") + ", " +
         download(name + "-2-columns.svg", "image/svg+xml", paper(kTwoColumns_mm), "SVG, 180 mm wide") + ", " +
         download(name + ".csv", "text/csv;charset=utf-8", data_csv(*figure), "data, CSV") +
         "</p></figure>\n";
}

std::string name_of(const std::string& condition) { return condition.empty() ? "all trials" : condition; }

std::string meanings_list(const SessionData& data) {
  std::string html;
  const auto add = [&html](const LevelAnalysis& part) {
    if (part.meaning.empty()) return;
    html += "<li>" + report::escaped((part.name.empty() ? "" : part.name + ": ") + part.meaning) + "</li>";
  };
  for (const auto& part : data.parts) add(part);
  if (data.parts.empty()) add(data);
  return html.empty() ? "" : "<p>What the protocol measures:</p>\n<ul>" + html + "</ul>\n";
}

}  // namespace turnpoint::report
