#include <fmt/format.h>

#include "station/core/letters.hpp"
#include "station/report/document.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

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

std::string html(const Text& text) {
  std::string all;
  for (const auto& [what, look] : text.runs) {
    if (const auto* number = std::get_if<Number>(&what)) {
      const auto [value, interval] = in_known_digits(*number);
      all += core::say(value, "en");
      if (!interval.empty()) all += " <span class=\"soft\">" + core::say(interval, "en") + "</span>";
      continue;
    }
    auto words = core::say(std::get<core::Phrase>(what), "en");
    if (look == Text::Look::label && !words.empty()) words[0] = core::upper(words[0]);
    words = escaped(words);
    switch (look) {
      case Text::Look::strong:
        words = "<b>" + words + "</b>";
        break;
      case Text::Look::soft:
        words = "<span class=\"soft\">" + words + "</span>";
        break;
      case Text::Look::code:
        words = "<code>" + words + "</code>";
        break;
      case Text::Look::below:
        words = "<sub>" + words + "</sub>";
        break;
      case Text::Look::plain:
      case Text::Look::label:
        break;
    }
    all += words;
  }
  return all;
}

std::string html(const Cell& cell) {
  const std::string name = cell.kind == Cell::Kind::head ? "th" : "td";
  auto start = "<" + name;
  if (cell.kind == Cell::Kind::number) start += " class=\"n\"";
  if (cell.kind == Cell::Kind::missing) start += " class=\"n soft\"";
  if (cell.columns > 1) start += fmt::format(" colspan=\"{}\"", cell.columns);
  if (cell.shade > 0) start += fmt::format(" style=\"background:rgba(0,114,178,{:.2f})\"", 0.6 * cell.shade);
  return start + ">" + html(cell.text) + "</" + name + ">";
}

struct Writer {
  std::string operator()(const Heading& heading) const {
    return fmt::format("<h{0}>{1}</h{0}>\n", heading.level, html(heading.text));
  }
  std::string operator()(const Paragraph& paragraph) const {
    return (paragraph.explains ? "<p class=\"soft\">" : "<p>") + html(paragraph.text) + "</p>\n";
  }
  std::string operator()(const analysis::Statement& statement) const {
    return "<p class=\"note\">" + html(Text(statement.text)) + "</p>\n";
  }
  std::string operator()(const List& list) const {
    std::string items;
    for (const auto& item : list.items) items += "<li>" + html(item) + "</li>";
    return "<ul>" + items + "</ul>\n";
  }
  std::string operator()(const Table& table) const {
    std::string rows;
    for (const auto& column : table.columns) rows += "<th>" + html(column.title) + "</th>";
    if (!rows.empty()) rows = "<tr>" + rows + "</tr>";
    for (const auto& cells : table.rows) {
      rows += "<tr>";
      for (const auto& cell : cells) rows += html(cell);
      rows += "</tr>";
    }
    return "<table>" + rows + "</table>\n";
  }
  std::string operator()(const NamedFigure& named) const {
    const auto paper = [&](double width_mm) {
      Svg svg(Svg::Unit::mm);
      draw(svg, for_paper(named.figure, width_mm));
      return svg.finish();
    };
    const auto& name = named.name;
    return "<figure>" + render(named.figure) + "<p class=\"soft save\">Save: " +
           download(name + "-1-column.svg", "image/svg+xml", paper(kOneColumn_mm), "SVG, 85 mm wide") + ", " +
           download(name + "-2-columns.svg", "image/svg+xml", paper(kTwoColumns_mm), "SVG, 180 mm wide") +
           ", " + download(name + ".csv", "text/csv;charset=utf-8", data_csv(named.figure), "data, CSV") +
           "</p></figure>\n";
  }
};

}  // namespace

std::string to_html(const Document& document) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
      escaped(document.name) + "</title>\n<style>" + kStyle + "</style></head><body>\n<h1>" +
      escaped(document.title) + "</h1>\n<p>" + html(document.about);
  if (document.run_mode != "live") page += " <span class=\"mode\">" + escaped(document.run_mode) + "</span>";
  page += "</p>\n";
  for (const auto& part : document.parts) page += std::visit(Writer{}, part);
  return page + "</body></html>\n";
}

}  // namespace turnpoint::report
