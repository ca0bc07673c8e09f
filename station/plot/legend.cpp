#include "station/plot/legend.hpp"

#include <algorithm>

namespace turnpoint::plot {

void marker(Canvas& canvas, Point at, double radius, const Style& style, bool open) {
  const Paint paint{style.colour, open ? "#ffffff" : style.colour, 1.6, "", 1};
  const auto [x, y] = at;
  const double r = radius;
  switch (style.marker) {
    case Marker::circle:
      canvas.circle(at, r, paint);
      break;
    case Marker::square:
      canvas.rectangle({x - 0.89 * r, y - 0.89 * r}, 1.78 * r, 1.78 * r, paint);
      break;
    case Marker::triangle:
      canvas.polygon({{x, y - 1.25 * r}, {x + 1.15 * r, y + 0.8 * r}, {x - 1.15 * r, y + 0.8 * r}}, paint);
      break;
    case Marker::diamond:
      canvas.polygon({{x, y - 1.3 * r}, {x + 1.3 * r, y}, {x, y + 1.3 * r}, {x - 1.3 * r, y}}, paint);
      break;
    case Marker::down:
      canvas.polygon({{x, y + 1.25 * r}, {x + 1.15 * r, y - 0.8 * r}, {x - 1.15 * r, y - 0.8 * r}}, paint);
      break;
    case Marker::cross:
      canvas.line({x - r, y - r}, {x + r, y + r}, {style.colour, "", 2, "", 1});
      canvas.line({x - r, y + r}, {x + r, y - r}, {style.colour, "", 2, "", 1});
      break;
  }
}

std::vector<LegendEntry> legend_of(const Chart& chart) {
  std::vector<LegendEntry> entries;
  const auto add = [&](const std::string& name, int series, bool LegendEntry::*what) {
    if (name.empty()) return;
    for (auto& entry : entries)
      if (entry.name == name && entry.series == series) {
        entry.*what = true;
        return;
      }
    entries.push_back({name, series, false, false, false, false});
    entries.back().*what = true;
  };
  for (const auto& layer : chart.layers) {
    if (const auto* line = std::get_if<Line>(&layer)) add(line->name, line->series, &LegendEntry::line);
    if (const auto* dots = std::get_if<Points>(&layer)) {
      const bool open =
          !dots->open.empty() && std::find(dots->open.begin(), dots->open.end(), false) == dots->open.end();
      add(dots->name, dots->series, open ? &LegendEntry::open_points : &LegendEntry::points);
    }
    if (const auto* band = std::get_if<Band>(&layer)) add(band->name, band->series, &LegendEntry::area);
    if (const auto* bars = std::get_if<Histogram>(&layer)) add(bars->name, bars->series, &LegendEntry::area);
  }
  return entries;
}

double draw_legend(Canvas* canvas, const std::vector<LegendEntry>& entries, double left, double top,
                   double width) {
  constexpr double sample = 24, gap = 18, row = 18;
  double x = left, y = top;
  for (const auto& entry : entries) {
    const double need = sample + 6 + text_width(entry.name, kText_px);
    if (x > left && x + need > left + width) x = left, y += row;
    if (canvas) {
      const auto look = style(entry.series);
      if (entry.area)
        canvas->rectangle({x, y + 3}, sample, 10, {"", look.colour, 0, "", entry.line ? 0.18 : 0.85});
      if (entry.line) canvas->line({x, y + 8}, {x + sample, y + 8}, {look.colour, "", 2, look.dash, 1});
      if (entry.points || entry.open_points) marker(*canvas, {x + sample / 2, y + 8}, 4, look, !entry.points);
      canvas->text({x + sample + 6, y + 12}, entry.name, kText_px, Anchor::start, kInk);
    }
    x += need + gap;
  }
  return entries.empty() ? 0 : y - top + row + 6;
}

}  // namespace turnpoint::plot
