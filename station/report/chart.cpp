#include "station/report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "station/report/canvas.hpp"
#include "station/report/palette.hpp"
#include "station/report/rule_labels.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

constexpr double kText_px = 12;
inline const std::string kInk = "#222222";  ///< colour of text and axes

/// Draws the style's marker, filled or open, with a nominal radius in px (see marker_radii_px).
void marker(Canvas& canvas, Point at, double radius, const Style& style, bool open);

/// One entry of the legend. Layers with the same name and series share one entry.
struct LegendEntry {
  std::string name;
  int series = 0;
  bool line = false, faint_line = false, points = false, open_points = false, area = false;
};

/// Returns an entry for each layer of the chart that has a name; none if there is only one, which has nothing
/// to be told from.
std::vector<LegendEntry> legend_of(const Chart& chart);

/// Returns the legend that all charts of the figure share; none if one of them has an entry that the chart
/// with most entries does not have.
std::vector<LegendEntry> shared_legend(const Figure& figure);

/// Draws the legend between title and data, in rows that fit the width (px). Returns its height in px.
/// Without a canvas it draws nothing.
double draw_legend(Canvas* canvas, const std::vector<LegendEntry>& entries, double left, double top,
                   double width);

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
    entries.push_back({name, series});
    entries.back().*what = true;
  };
  for (const auto& layer : chart.layers) {
    if (const auto* line = std::get_if<Line>(&layer))
      add(line->name, line->series, line->faint ? &LegendEntry::faint_line : &LegendEntry::line);
    if (const auto* dots = std::get_if<Points>(&layer)) {
      const bool open =
          !dots->open.empty() && std::find(dots->open.begin(), dots->open.end(), false) == dots->open.end();
      add(dots->name, dots->series, open ? &LegendEntry::open_points : &LegendEntry::points);
    }
    if (const auto* band = std::get_if<Band>(&layer)) add(band->name, band->series, &LegendEntry::area);
    if (const auto* bars = std::get_if<Histogram>(&layer)) add(bars->name, bars->series, &LegendEntry::area);
  }
  if (entries.size() == 1) entries.clear();
  return entries;
}

std::vector<LegendEntry> shared_legend(const Figure& figure) {
  if (figure.charts.size() < 2) return {};
  std::vector<std::vector<LegendEntry>> all;
  for (const auto& chart : figure.charts) all.push_back(legend_of(chart));
  auto most = *std::max_element(all.begin(), all.end(),
                                [](const auto& a, const auto& b) { return a.size() < b.size(); });
  int charts = 0;
  for (const auto& entries : all) {
    charts += entries.empty() ? 0 : 1;
    for (const auto& entry : entries) {
      const auto same = std::find_if(most.begin(), most.end(), [&](const LegendEntry& other) {
        return other.name == entry.name && other.series == entry.series;
      });
      if (same == most.end()) return {};
      for (const auto what : {&LegendEntry::line, &LegendEntry::faint_line, &LegendEntry::points,
                              &LegendEntry::open_points, &LegendEntry::area})
        (*same).*what = (*same).*what || entry.*what;
    }
  }
  return charts > 1 ? most : std::vector<LegendEntry>();
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
      if (entry.faint_line)
        canvas->line({x, y + 8}, {x + sample, y + 8}, {look.colour, "", 1, look.dash, 0.4});
      if (entry.points || entry.open_points) marker(*canvas, {x + sample / 2, y + 8}, 4, look, !entry.points);
      canvas->text({x + sample + 6, y + 12}, entry.name, kText_px, Anchor::start, kInk);
    }
    x += need + gap;
  }
  return entries.empty() ? 0 : y - top + row + 6;
}

namespace {

constexpr double kTitle = 13.5, kPad = 10, kTick = 5, kCaptionLine = 16;
// of a chart: its least size in px, and its best proportions
constexpr double kLeastWidth = 200, kLeastHeight = 165, kBestShape = 1.5;
const std::string kSoft = "#545454", kGrid = "#e6e6e6";

void check(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument("plot: " + what);
}

struct Draw {
  Canvas& canvas;
  const Frame& frame;

  void operator()(const Band& band) const {
    check(band.x.size() == band.low.size() && band.x.size() == band.high.size(),
          "the lists of a band must have the same length");
    std::vector<Point> outline;
    for (std::size_t i = 0; i < band.x.size(); ++i) outline.push_back(frame.at(band.x[i], band.low[i]));
    for (std::size_t i = band.x.size(); i-- > 0;) outline.push_back(frame.at(band.x[i], band.high[i]));
    if (!outline.empty()) canvas.polygon(outline, {"", style(band.series).colour, 0, "", 0.18});
  }

  void operator()(const Histogram& bars) const {
    check(bars.edges.size() == bars.heights.size() + 1, "a histogram must have one more edge than heights");
    for (std::size_t i = 0; i < bars.heights.size(); ++i) {
      if (bars.heights[i] == 0) continue;
      const auto from = frame.at(bars.edges[i], bars.heights[i]), to = frame.at(bars.edges[i + 1], 0);
      canvas.rectangle(from, to.first - from.first, to.second - from.second,
                       {"#ffffff", style(bars.series).colour, 0.8, "", 0.85});
    }
  }

  void operator()(const HeatMap& map) const {
    const std::size_t columns = map.x_edges.size() - 1, rows = map.y_edges.size() - 1;
    check(!map.x_edges.empty() && !map.y_edges.empty() && map.values.size() == columns * rows,
          "a heat map needs one value for each column and row");
    check(map.low < map.high, "a heat map needs a range of values");
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column) {
        const double value = map.values[row * columns + column];
        if (!std::isfinite(value)) continue;
        const auto from = frame.at(map.x_edges[column], map.y_edges[row + 1]);
        const auto to = frame.at(map.x_edges[column + 1], map.y_edges[row]);
        const auto colour = shade((value - map.low) / (map.high - map.low));
        canvas.rectangle(from, to.first - from.first, to.second - from.second, {colour, colour, 0.4, "", 1});
      }
  }

  /// Draws only the rule's line. Its label is drawn after everything else, in a free place.
  void operator()(const Rule& rule) const {
    if (!is_shown(rule, frame)) return;
    const auto [from, to] = ends_of(rule, frame);
    canvas.line(from, to, {rule.series == kNeutral ? kSoft : style(rule.series).colour, "", 1, "3 3", 1});
  }

  void operator()(const Line& curve) const {
    check(curve.x.size() == curve.y.size(),
          "line \"" + curve.name + "\": the lists of x and y must have the same length");
    const auto look = style(curve.series);
    const report::Paint paint{look.colour, "", curve.faint || curve.beyond ? 1.0 : 2.0,
                              curve.beyond ? "3 3" : look.dash, curve.faint ? 0.4 : 1};
    std::vector<Point> run;
    const auto flush = [&] {
      if (run.size() > 1) canvas.polyline(run, paint);
      run.clear();
    };
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (drawable(*frame.across, curve.x[i]) && drawable(*frame.up, curve.y[i]))
        run.push_back(frame.at(curve.x[i], curve.y[i]));
      else
        flush();
    }
    flush();
  }

  void operator()(const Points& dots) const {
    const std::size_t n = dots.x.size();
    const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
    check(dots.y.size() == n && fits(dots.low.size()) && dots.low.size() == dots.high.size() &&
              fits(dots.weight.size()) && fits(dots.open.size()),
          "points \"" + dots.name + "\": the lists must have the same length");
    const auto look = style(dots.series);
    const auto radii = marker_radii_px(dots);
    for (std::size_t i = 0; i < dots.low.size(); ++i) {
      if (!drawable(*frame.across, dots.x[i])) continue;
      const auto part = shown(*frame.up, dots.low[i], dots.high[i]);
      if (!part) continue;
      const auto low = frame.at(dots.x[i], part->low), high = frame.at(dots.x[i], part->high);
      canvas.line(low, high, {look.colour, "", 1.3, "", 1});
      if (part->cut_low) arrow(low, 0, 1, look.colour);
      if (part->cut_high) arrow(high, 0, -1, look.colour);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!drawable(*frame.across, dots.x[i]) || !drawable(*frame.up, dots.y[i])) continue;
      marker(canvas, frame.at(dots.x[i], dots.y[i]), radii[i], look, !dots.open.empty() && dots.open[i]);
    }
  }

  void operator()(const Span& span) const {
    if (!drawable(*frame.up, span.at)) return;
    const auto part = shown(*frame.across, span.low, span.high);
    if (!part) return;
    constexpr double cap = 4;
    const auto colour = style(span.series).colour;
    const auto end = [&](Point at, bool cut, double towards) {
      if (cut)
        arrow(at, towards, 0, colour);
      else
        canvas.line({at.first, at.second - cap}, {at.first, at.second + cap}, {colour, "", 1.6, "", 1});
    };
    const auto low = frame.at(part->low, span.at), high = frame.at(part->high, span.at);
    canvas.line(low, high, {colour, "", 1.6, "", 1});
    end(low, part->cut_low, -1);
    end(high, part->cut_high, 1);
  }

  /// An arrow with its tip at the edge of the axes, in the direction of the part of an interval that is not
  /// shown.
  void arrow(Point tip, double to_right, double down, const std::string& colour) const {
    constexpr double length = 8, half = 4;
    const auto [x, y] = tip;
    const double back_x = x - length * to_right, back_y = y - length * down;
    canvas.polygon({tip,
                    {back_x - half * down, back_y - half * to_right},
                    {back_x + half * down, back_y + half * to_right}},
                   {"", colour, 0, "", 1});
  }
};

const HeatMap* heat_map(const Chart& chart) {
  for (const auto& layer : chart.layers)
    if (const auto* map = std::get_if<HeatMap>(&layer)) return map;
  return nullptr;
}

void draw_colour_bar(Canvas& canvas, const Frame& frame, double from, const HeatMap& map) {
  const double left = from + 12, width = 12;
  constexpr int steps = 32;
  for (int i = 0; i < steps; ++i) {
    const auto colour = shade((i + 0.5) / steps);
    canvas.rectangle({left, frame.y + frame.height * (steps - 1 - i) / steps}, width,
                     frame.height / steps + 0.5, {"", colour, 0, "", 1});
  }
  const Axis axis{map.name, map.low, map.high, AxisScale::linear};
  for (const auto& tick : ticks(axis, 4))
    canvas.text({left + width + 5, frame.y + (1 - position(axis, tick.value)) * frame.height + 4}, tick.label,
                kText_px - 1, Anchor::start, kSoft);
  canvas.text({left + width + 46, frame.y + frame.height / 2}, map.name, kText_px, Anchor::middle, kInk, 400,
              90);
}

/// True if the labels of these ticks do not touch each other along an axis of this width.
bool have_room(const std::vector<Tick>& list, const Axis& axis, double width) {
  double free_from = -1e9;
  return std::all_of(list.begin(), list.end(), [&](const Tick& tick) {
    const double x = position(axis, tick.value) * width, half = text_width(tick.label, kText_px) / 2;
    const bool free = x - half >= free_from;
    free_from = x + half + 6;
    return free;
  });
}

/// If the names on a horizontal axis do not fit beside each other, they are turned upright. Returns the
/// height in px that they then need below an ordinary label; otherwise 0.
double turned_names_px(const Axis& axis, double width) {
  if (axis.names.empty()) return 0;
  const auto names = ticks(axis);
  if (have_room(names, axis, width)) return 0;
  double longest = 0;
  for (const auto& tick : names) longest = std::max(longest, text_width(tick.label, kText_px));
  return longest + 4 - kText_px;
}

/// The area of one chart, and which labels of its axes it shows.
struct Place {
  double left = 0, top = 0, width = 0, height = 0;
  bool left_labels = true, bottom_labels = true;
  double below = 0;  ///< room in px for the labels below the data
};

void draw_axes(Canvas& canvas, const Frame& frame, const std::vector<Tick>& across,
               const std::vector<Tick>& up, const Place& place) {
  const double bottom = frame.y + frame.height;
  double free_below = 1e9;
  for (const auto& tick : up) {
    const double y = frame.at(frame.across->low, tick.value).second;
    canvas.line({frame.x, y}, {frame.x + frame.width, y}, {kGrid, "", 1, "", 1});
    if (!place.left_labels || y > free_below) continue;  // skip labels that would touch the one below
    free_below = y - 1.1 * kText_px;
    canvas.text({frame.x - kTick - 3, y + 4}, tick.label, kText_px, Anchor::end, kInk);
  }
  const double turned_px = turned_names_px(*frame.across, frame.width);
  double free_from = -1e9;
  for (const auto& tick : across) {
    const double x = frame.at(tick.value, frame.up->low).first;
    canvas.line({x, bottom}, {x, bottom + kTick}, {kInk, "", 1, "", 1});
    if (!place.bottom_labels) continue;
    if (turned_px > 0) {
      if (x - kText_px / 2 < free_from) continue;
      canvas.text({x + 4, bottom + kTick + 4}, tick.label, kText_px, Anchor::end, kInk, 400, 90);
      free_from = x + kText_px / 2;
      continue;
    }
    const double half = text_width(tick.label, kText_px) / 2;
    if (x - half < free_from) continue;  // skip labels that would touch the previous one
    canvas.text({x, bottom + kTick + 13}, tick.label, kText_px, Anchor::middle, kInk);
    free_from = x + half + 6;
  }
  canvas.line({frame.x, bottom}, {frame.x + frame.width, bottom}, {kInk, "", 1, "", 1});
  if (place.bottom_labels)
    canvas.text({frame.x + frame.width / 2, bottom + 37 + turned_px}, frame.across->label, kText_px,
                Anchor::middle, kInk);
}

/// Returns those ticks of the horizontal axis whose labels fit. On a log axis, some ticks have no label.
std::vector<Tick> ticks_with_room(const Axis& axis, double width) {
  for (int wanted = 7; wanted > 2 && axis.scale == AxisScale::linear; --wanted)
    if (const auto some = ticks(axis, wanted); have_room(some, axis, width)) return some;
  return ticks(axis, axis.scale == AxisScale::linear ? 2 : 7);
}

/// How a chart's area is divided among title, legend and data.
struct Division {
  double left = 0, width = 0, legend_top = 0;  ///< left end and width of the data area; top of the legend
  std::vector<Tick> up;
  std::vector<LegendEntry> entries;
  std::vector<Layer> layers;  ///< the chart's layers, with intervals beside each other
  Labelled labelled;
};

constexpr double kRightRoom = kPad + 6;

/// The room in px for the labels at the left of the data.
double left_room(const std::vector<Tick>& up) {
  double labels = 0;
  for (const auto& tick : up) labels = std::max(labels, text_width(tick.label, kText_px));
  return kPad + 18 + labels + kTick + 3;
}

/// The room in px for the labels below data of this width.
double room_below(const Axis& axis, double width) { return kPad + 38 + turned_names_px(axis, width); }

Division divided(const Chart& chart, const Place& place, const std::vector<LegendEntry>& entries,
                 VerticalLabels where, int wanted_ticks) {
  Division d;
  d.up = ticks(chart.y, wanted_ticks);
  d.left = place.left + (place.left_labels ? left_room(d.up) : kPad);
  d.width = place.left + place.width - kRightRoom - (heat_map(chart) ? 72 : 0) - d.left;
  d.legend_top = place.top + kPad + (chart.title.empty() ? 4 : 26);
  d.entries = entries;
  Frame frame{d.left, d.legend_top, d.width, 0, &chart.x, &chart.y};
  frame.y += draw_legend(nullptr, d.entries, d.left, 0, d.width);
  frame.height = place.top + place.height - place.below - frame.y;
  d.layers = beside(chart, frame);
  Chart moved;
  moved.layers = d.layers;
  d.labelled = place_labels(moved, frame, where, d.up);
  return d;
}

/// Divides a chart's area among title, legend and data. The vertical axis gets as many ticks as fit with a
/// distance of one and a half lines of text.
Division divided(const Chart& chart, const Place& place, const std::vector<LegendEntry>& entries,
                 VerticalLabels where) {
  for (int wanted = 5;; --wanted) {
    auto d = divided(chart, place, entries, where, wanted);
    const double needed = 1.5 * kText_px * static_cast<double>(d.up.size() - 1);
    if (wanted == 2 || needed <= d.labelled.frame.height) return d;
  }
}

bool has_room(const Division& d) { return d.labelled.frame.width > 40 && d.labelled.frame.height > 40; }

/// Draws a chart's title above its data. A long title begins further left, and shrinks if that is not enough.
void draw_title(Canvas& canvas, const std::string& title, const Place& place, double left) {
  const double right = place.left + place.width - kPad;
  const double width = text_width(title, kTitle);
  const double begin = std::max(place.left + kPad, std::min(left, right - width));
  const double size = width > right - begin ? kTitle * (right - begin) / width : kTitle;
  canvas.text({begin, place.top + kPad + 14}, title, size, Anchor::start, kInk, 600);
}

void draw_chart(Canvas& canvas, const Chart& chart, const Place& place, const Division& d) {
  const auto& frame = d.labelled.frame;
  draw_title(canvas, chart.title, place, d.left);
  draw_legend(&canvas, d.entries, d.left, d.legend_top, d.width);
  draw_axes(canvas, frame, ticks_with_room(chart.x, frame.width), d.up, place);
  if (place.left_labels)
    canvas.text({place.left + kPad + 10, frame.y + frame.height / 2}, chart.y.label, kText_px, Anchor::middle,
                kInk, 400, 90);
  const auto clip = drawn_in(frame);
  canvas.begin_clip({clip.left, clip.top}, clip.right - clip.left, clip.bottom - clip.top);
  for (const auto& layer : d.layers) std::visit(Draw{canvas, frame}, layer);
  canvas.end_clip();
  for (const auto& label : d.labelled.labels)
    canvas.text(label.at, label.text, kLabelText_px, label.anchor,
                label.series == kNeutral ? kSoft : style(label.series).colour);
  if (const auto* map = heat_map(chart)) draw_colour_bar(canvas, frame, d.left + d.width, *map);
}

/// Where everything of a figure stands.
struct Layout {
  std::vector<LegendEntry> legend;  ///< of all charts; empty if each has its own
  double legend_height = 0;
  std::vector<Place> places;
  std::vector<Division> divisions;
};

/// Breaks the caption into lines that fit the width.
std::vector<std::string> caption_lines(const std::string& caption, double width) {
  std::vector<std::string> lines;
  std::istringstream words(caption);
  for (std::string word; words >> word;) {
    if (lines.empty() || text_width(lines.back() + " " + word, kText_px) > width)
      lines.push_back(word);
    else
      lines.back() += " " + word;
  }
  return lines;
}

std::pair<int, int> columns_and_rows(const Figure& figure) {
  const int count = static_cast<int>(figure.charts.size()), columns = std::min(figure.columns, count);
  return {columns, (count + columns - 1) / columns};
}

bool all_have(const Figure& figure, Axis Chart::*axis) {
  return std::all_of(figure.charts.begin(), figure.charts.end(),
                     [&](const Chart& chart) { return chart.*axis == figure.charts.front().*axis; });
}

/// The places of the charts below a legend of this height. All charts get data areas of the same size if they
/// share an axis.
std::vector<Place> places_of(const Figure& figure, double legend_height) {
  const auto [columns, rows] = columns_and_rows(figure);
  const auto count = static_cast<int>(figure.charts.size());
  const auto& first = figure.charts.front();
  const bool shares_x = rows > 1 && all_have(figure, &Chart::x);
  const bool shares_y = columns > 1 && all_have(figure, &Chart::y);
  const double extra_left = shares_y ? left_room(ticks(first.y, 5)) - kPad : 0;
  const double width = (columns * figure.chart_width_px - extra_left) / columns;
  const auto below = [&](const Chart& chart) {
    return room_below(chart.x, width - kRightRoom - (shares_y ? kPad : left_room(ticks(chart.y, 5))));
  };
  const double extra_below = shares_x ? below(first) - kPad : 0;
  const double height = (rows * figure.chart_height_px - legend_height - extra_below) / rows;
  std::vector<Place> places;
  for (int i = 0; i < count; ++i) {
    const int column = i % columns, row = i / columns;
    const bool leftmost = column == 0, last = row == rows - 1;
    Place place;
    place.left = column * width + (leftmost ? 0 : extra_left);
    place.top = legend_height + row * height;
    place.width = width + (leftmost ? extra_left : 0);
    place.height = height + (last ? extra_below : 0);
    place.left_labels = leftmost || !shares_y;
    place.bottom_labels = i + columns >= count || !shares_x;
    place.below = last || !shares_x ? below(figure.charts[static_cast<std::size_t>(i)]) : kPad;
    places.push_back(place);
  }
  return places;
}

/// Charts side by side must have data areas of the same height: if one chart has a label above its data, all
/// charts leave room for one.
Layout laid_out_charts(const Figure& figure) {
  Layout layout;
  layout.legend = shared_legend(figure);
  const auto [columns, rows] = columns_and_rows(figure);
  const double width = columns * figure.chart_width_px - 4 * kPad;
  layout.legend_height = layout.legend.empty() ? 0 : kPad + draw_legend(nullptr, layout.legend, 0, 0, width);
  layout.places = places_of(figure, layout.legend_height);
  const auto divide = [&](VerticalLabels where) {
    layout.divisions.clear();
    for (std::size_t i = 0; i < layout.places.size(); ++i) {
      const auto& chart = figure.charts[i];
      const auto entries = layout.legend.empty() ? legend_of(chart) : std::vector<LegendEntry>();
      layout.divisions.push_back(divided(chart, layout.places[i], entries, where));
    }
  };
  divide(VerticalLabels::beside);
  const bool above = std::any_of(layout.divisions.begin(), layout.divisions.end(), [](const Division& d) {
    return std::any_of(d.labelled.labels.begin(), d.labelled.labels.end(),
                       [](const RuleLabel& label) { return label.anchor == Anchor::middle; });
  });
  if (above) divide(VerticalLabels::above);
  return layout;
}

}  // namespace

void draw(Canvas& canvas, const Figure& figure) {
  check(!figure.charts.empty(), "a figure needs a chart");
  check(figure.columns > 0, "the number of columns must be at least 1");
  const auto layout = laid_out_charts(figure);
  for (std::size_t i = 0; i < layout.places.size(); ++i)
    check(has_room(layout.divisions[i]),
          "chart \"" + figure.charts[i].title + "\" leaves no room for its data");
  const auto [width, height] = size_px(figure);
  const auto caption = caption_lines(figure.caption, width - 4 * kPad);
  canvas.begin(width, height, figure.title);
  canvas.rectangle({0, 0}, width, height, {"", "#ffffff", 0, "", 1});
  draw_legend(&canvas, layout.legend, 2 * kPad, kPad, width - 4 * kPad);
  for (std::size_t i = 0; i < layout.places.size(); ++i)
    draw_chart(canvas, figure.charts[i], layout.places[i], layout.divisions[i]);
  double y = height - caption_height_px(figure) + kText_px;
  for (const auto& line : caption) {
    canvas.text({2 * kPad, y}, line, kText_px, Anchor::start, kSoft);
    y += kCaptionLine;
  }
}

bool has_moved(const Figure& figure) {
  const auto layout = laid_out_charts(figure);
  for (std::size_t i = 0; i < figure.charts.size(); ++i)
    for (std::size_t n = 0; n < figure.charts[i].layers.size(); ++n) {
      const auto &given = figure.charts[i].layers[n], &drawn = layout.divisions[i].layers[n];
      if (const auto* dots = std::get_if<Points>(&given))
        if (const auto& moved = std::get<Points>(drawn); moved.x != dots->x || moved.y != dots->y)
          return true;
      if (const auto* span = std::get_if<Span>(&given))
        if (std::get<Span>(drawn).at != span->at) return true;
    }
  return false;
}

int columns_for(const Figure& figure, double width_px) {
  const int count = static_cast<int>(figure.charts.size());
  constexpr double smallest_title = 10;
  int best = 1, fewest = count;
  for (int columns = std::min(3, count); columns > 1; --columns) {
    const double width = width_px / columns;
    const bool fits = width >= kLeastWidth &&
                      std::all_of(figure.charts.begin(), figure.charts.end(), [&](const Chart& chart) {
                        return text_width(chart.title, smallest_title) <= width - 2 * kPad &&
                               text_width(chart.x.label, kText_px) <= width;
                      });
    const int empty = (columns - count % columns) % columns;
    if (fits && empty < fewest) fewest = empty, best = columns;
  }
  return best;
}

Figure on_page(Figure figure, double chart_height_px) {
  constexpr double one_px = 620, all_px = 800;
  figure.columns = columns_for(figure, all_px);
  figure.chart_width_px = figure.columns == 1 ? one_px : all_px / figure.columns;
  figure.chart_height_px = chart_height_px;
  return figure;
}

double least_data_px(const Figure& figure) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& d : laid_out_charts(figure).divisions) least = std::min(least, d.labelled.frame.height);
  return least;
}

Point size_px(const Figure& figure) {
  const auto [columns, rows] = columns_and_rows(figure);
  return {columns * figure.chart_width_px, rows * figure.chart_height_px + caption_height_px(figure)};
}

double caption_height_px(const Figure& figure) {
  const int columns = std::min(figure.columns, static_cast<int>(figure.charts.size()));
  const auto lines = caption_lines(figure.caption, columns * figure.chart_width_px - 4 * kPad).size();
  return lines == 0 ? 0 : kPad + kCaptionLine * static_cast<double>(lines);
}

std::string render(const Figure& figure) {
  Svg svg;
  draw(svg, figure);
  return svg.finish();
}

Figure laid_out(Figure figure, double width_px, double height_px) {
  check(width_px > 0 && height_px > 0, "the size of a figure must be above 0");
  const auto count = static_cast<int>(figure.charts.size());
  Figure chosen = figure;
  double nearest = std::numeric_limits<double>::infinity();
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    const double larger = std::max({1.0, kLeastWidth * columns / width_px, kLeastHeight * rows / height_px});
    const double width = width_px * larger;
    const auto caption = static_cast<double>(caption_lines(figure.caption, width - 4 * kPad).size());
    figure.columns = columns;
    figure.chart_width_px = width / columns;
    figure.chart_height_px = std::max(
        kLeastHeight, (height_px * larger - (caption > 0 ? kPad + kCaptionLine * caption : 0)) / rows);
    // Prefer the layout whose charts are closest to the best proportions, and whose document grows least.
    const double off = std::abs(std::log(figure.chart_width_px / figure.chart_height_px / kBestShape)) +
                       2 * std::log(larger);
    if (off < nearest) nearest = off, chosen = figure;
  }
  return chosen;
}

Figure laid_out_to_scroll(Figure figure, double width_px, double height_px) {
  const auto caption_px = [&] {
    auto one_column = figure;
    one_column.columns = 1, one_column.chart_width_px = width_px;
    return caption_height_px(one_column);
  }();
  const auto caption = std::exchange(figure.caption, "");
  // a caption leaves the charts four fifths of the height, or else stands below what is seen first
  if (caption_px <= 0.2 * height_px) height_px -= caption_px;
  const auto all_has_room = [](const Figure& placed) {
    const auto divisions = laid_out_charts(placed).divisions;
    for (std::size_t i = 0; i < divisions.size(); ++i) {
      const auto& label =
          placed.charts[i].y.label;  // reaches beyond the data, as far as the numbers below it
      const double room_px = divisions[i].labelled.frame.height + 2 * 40;
      if (!has_room(divisions[i]) || text_width(label, kText_px) > room_px) return false;
    }
    return true;
  };
  auto placed = laid_out(figure, width_px, height_px);
  if (size_px(placed).first > width_px + 0.5 || !all_has_room(placed)) {
    placed.columns = 1;
    placed.chart_width_px = std::max(width_px, kLeastWidth);
    placed.chart_height_px =
        std::clamp(placed.chart_width_px / kBestShape, kLeastHeight, std::max(kLeastHeight, height_px));
    // a long legend, or a long label beside the data, needs more height than is seen at once
    for (int i = 0; i < 10 && !all_has_room(placed); ++i) placed.chart_height_px *= 1.15;
  }
  placed.caption = caption;
  return placed;
}

Histogram histogram(const std::vector<double>& values, double low, double high, int bins) {
  check(low < high && bins > 0,
        "a histogram needs at least one bin, and its low limit must be below the high one");
  Histogram result;
  for (int i = 0; i <= bins; ++i) result.edges.push_back(low + (high - low) * i / bins);
  result.heights.assign(static_cast<std::size_t>(bins), 0);
  for (const double value : values) {
    if (!(value >= low && value <= high)) continue;
    const auto bin = std::min(static_cast<int>((value - low) / (high - low) * bins), bins - 1);
    result.heights[static_cast<std::size_t>(bin)] += 1;
  }
  return result;
}

}  // namespace turnpoint::report
