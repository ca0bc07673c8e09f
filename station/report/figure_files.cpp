#include "station/report/figure_files.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "station/report/study.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {

constexpr double kPixelsPerMm = 96 / 25.4;
/// A figure of several rows is not made higher than this, unless legends and labels need it.
constexpr double kHighest_mm = 180;
/// A page of a journal is about 230 mm high. A figure that would be higher, or whose data would be lower than
/// this, gets more charts beside each other, as long as they are wide enough.
constexpr double kPage_mm = 230, kLowest_px = 60, kNarrowest_px = 150;

/// Writes the rows of one chart.
struct Rows {
  std::string start;  ///< the columns that all rows of the chart share
  std::string& csv;

  void row(const char* kind, const std::string& series, std::initializer_list<std::string> cells) const {
    csv += start + kind + "," + csv_field(series);
    for (const auto& text : cells) csv += "," + text;
    csv += "\n";
  }
  void operator()(const Line& line) const {
    for (std::size_t i = 0; i < line.x.size(); ++i)
      row("curve", line.name, {csv_number(line.x[i]), "", "", csv_number(line.y[i]), "", "", "", ""});
  }
  void operator()(const Points& dots) const {
    const auto at = [](const std::vector<double>& list, std::size_t i) {
      return i < list.size() ? csv_number(list[i]) : "";
    };
    for (std::size_t i = 0; i < dots.x.size(); ++i)
      row("marker", dots.name,
          {csv_number(dots.x[i]), "", "", csv_number(dots.y[i]), at(dots.low, i), at(dots.high, i),
           at(dots.weight, i),
           i >= dots.open.size() ? ""
           : dots.open[i]        ? "1"
                                 : "0"});
  }
  void operator()(const Band& band) const {
    for (std::size_t i = 0; i < band.x.size(); ++i)
      row("band", band.name,
          {csv_number(band.x[i]), "", "", "", csv_number(band.low[i]), csv_number(band.high[i]), "", ""});
  }
  void operator()(const Histogram& bars) const {
    for (std::size_t i = 0; i < bars.heights.size(); ++i)
      row("bar", bars.name,
          {"", csv_number(bars.edges[i]), csv_number(bars.edges[i + 1]), csv_number(bars.heights[i]), "", "",
           "", ""});
  }
  void operator()(const HeatMap& map) const {
    const std::size_t columns = map.x_edges.size() - 1;
    for (std::size_t i = 0; i < map.values.size(); ++i)
      row("cell", map.name,
          {"", csv_number(map.x_edges[i % columns]), csv_number(map.x_edges[i % columns + 1]), "",
           csv_number(map.y_edges[i / columns]), csv_number(map.y_edges[i / columns + 1]),
           csv_number(map.values[i]), ""});
  }
  void operator()(const Rule& rule) const {
    if (rule.direction == Rule::Direction::horizontal)
      row("rule", rule.label, {"", "", "", csv_number(rule.at), "", "", "", ""});
    else
      row("rule", rule.label, {csv_number(rule.at), "", "", "", "", "", "", ""});
  }
  void operator()(const Span& span) const {
    row("interval", "",
        {"", csv_number(span.low), csv_number(span.high), csv_number(span.at), "", "", "", ""});
  }
};

}  // namespace

std::string data_csv(const Figure& figure) {
  std::string csv = "chart,x_axis,y_axis,kind,series,x,x_low,x_high,y,y_low,y_high,value,open\n";
  int number = 0;
  for (const auto& chart : figure.charts) {
    ++number;
    const auto title = chart.title.empty() ? std::to_string(number) : chart.title;
    const auto start =
        csv_field(title) + "," + csv_field(chart.x.label) + "," + csv_field(chart.y.label) + ",";
    for (const auto& layer : chart.layers) std::visit(Rows{start, csv}, layer);
    for (std::size_t i = 0; i < chart.x.names.size(); ++i)
      Rows{start, csv}.row("name", chart.x.names[i], {std::to_string(i + 1), "", "", "", "", "", "", ""});
    for (std::size_t i = 0; i < chart.y.names.size(); ++i)
      Rows{start, csv}.row("name", chart.y.names[i], {"", "", "", std::to_string(i + 1), "", "", "", ""});
  }
  return csv;
}

namespace {

/// Lays a figure out in this width with this many charts beside each other.
Figure in_columns(Figure figure, double width_px, int columns) {
  const double shape = std::clamp(figure.chart_height_px / figure.chart_width_px, 0.62, 1.0);
  figure.columns = columns;
  figure.chart_width_px = width_px / columns;
  const auto charts = static_cast<int>(figure.charts.size());
  const int rows = (charts + columns - 1) / columns;
  // titles, legends and axes take as much height in a narrow chart as in a wide one
  const double wanted_px = figure.chart_width_px * shape + (figure.chart_width_px < 400 ? 50 : 0);
  const double share_px = kHighest_mm * kPixelsPerMm / rows;
  figure.chart_height_px = rows > 1 ? std::min(wanted_px, share_px) : wanted_px;
  // legends and labels never leave less than this to the data
  const double least_px = std::min(0.45 * figure.chart_width_px, 0.5 * share_px);
  for (int i = 0; i < 40 && least_data_px(figure) < least_px; ++i) figure.chart_height_px += 10;
  return figure;
}

}  // namespace

Figure for_paper(Figure figure, double width_mm) {
  figure.caption.clear();
  const double width_px = width_mm * kPixelsPerMm;
  int columns = width_mm < 120 ? 1 : columns_for(figure, width_px);
  auto laid_out = in_columns(figure, width_px, columns);
  const auto flat = [&] {
    return size_px(laid_out).second > kPage_mm * kPixelsPerMm || least_data_px(laid_out) < kLowest_px;
  };
  while (columns < std::ssize(figure.charts) && flat() && width_px / (columns + 1) >= kNarrowest_px)
    laid_out = in_columns(figure, width_px, ++columns);
  return laid_out;
}

std::vector<FigureFile> figure_files(const NamedFigure& named, const PdfOf& pdf_of) {
  std::vector<FigureFile> files;
  for (const auto& [width_mm, suffix] :
       {std::pair(kOneColumn_mm, "-1-column"), {kTwoColumns_mm, "-2-columns"}}) {
    const auto figure = for_paper(named.figure, width_mm);
    Svg svg(Svg::Unit::mm);
    draw(svg, figure);
    files.push_back({named.name + suffix + ".svg", svg.finish()});
    if (auto pdf = pdf_of(figure); !pdf.empty())
      files.push_back({named.name + suffix + ".pdf", std::move(pdf)});
  }
  files.push_back({named.name + ".csv", data_csv(named.figure)});
  files.push_back({named.name + ".txt", named.figure.title + ". " + named.figure.caption + "\n"});
  return files;
}

}  // namespace turnpoint::report
