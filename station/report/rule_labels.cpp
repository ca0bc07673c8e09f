#include "station/report/rule_labels.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace turnpoint::report {

namespace {

constexpr double kAscent = 9.5, kDescent = 3, kRow = 13, kBesideRule = 4;
constexpr double kBeside_px = 8;     // between intervals that would lie on each other
constexpr double kSamePlace_px = 3;  // intervals closer than this lie on each other
constexpr double kLeastBeside_px = 4;
constexpr double kArrow_px = 4;
constexpr double kOver = 6;  // how far lines and markers may extend beyond the frame, in px

Box box_of(const std::string& text, Point at, Anchor anchor) {
  const double width = text_width(text, kLabelText_px);
  const double left = at.first - width * (anchor == Anchor::start ? 0 : anchor == Anchor::middle ? 0.5 : 1);
  return {left, at.second - kAscent, left + width, at.second + kDescent};
}

RuleLabel label_at(const Rule& rule, Point at, Anchor anchor) {
  return {rule.label, at, anchor, box_of(rule.label, at, anchor), rule.series};
}

bool is_flat(const Rule& rule) { return rule.direction == Rule::Direction::horizontal; }

/// Covers a straight line with boxes of a few px. A single box around a sloping line would also cover much
/// free space.
void cover(std::vector<Box>& boxes, Point a, Point b, double half) {
  const double length = std::max(std::abs(b.first - a.first), std::abs(b.second - a.second));
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / 4)));
  for (int i = 0; i < pieces; ++i) {
    const auto along = [&](int step) {
      const double share = static_cast<double>(step) / pieces;
      return Point{a.first + share * (b.first - a.first), a.second + share * (b.second - a.second)};
    };
    const auto [x0, y0] = along(i);
    const auto [x1, y1] = along(i + 1);
    boxes.push_back(
        {std::min(x0, x1) - half, std::min(y0, y1) - half, std::max(x0, x1) + half, std::max(y0, y1) + half});
  }
}

struct Cover {
  std::vector<Box>& boxes;
  const Frame& frame;

  void operator()(const Band&) const {}
  void operator()(const HeatMap&) const {
    boxes.push_back({frame.x, frame.y, frame.x + frame.width, frame.y + frame.height});
  }
  void operator()(const Rule& rule) const {
    if (!is_shown(rule, frame)) return;
    const auto [from, to] = ends_of(rule, frame);
    cover(boxes, from, to, 0.5);
  }
  void operator()(const Histogram& bars) const {
    for (std::size_t i = 0; i < bars.heights.size() && i + 1 < bars.edges.size(); ++i) {
      if (bars.heights[i] == 0) continue;
      const auto from = frame.at(bars.edges[i], bars.heights[i]), to = frame.at(bars.edges[i + 1], 0);
      boxes.push_back({from.first, from.second, to.first, to.second});
    }
  }
  void operator()(const Line& curve) const {
    const auto shown = [&](std::size_t i) {
      return drawable(*frame.across, curve.x[i]) && drawable(*frame.up, curve.y[i]);
    };
    for (std::size_t i = 1; i < std::min(curve.x.size(), curve.y.size()); ++i)
      if (shown(i - 1) && shown(i))
        cover(boxes, frame.at(curve.x[i - 1], curve.y[i - 1]), frame.at(curve.x[i], curve.y[i]), 1);
  }
  void operator()(const Points& dots) const {
    const auto radii = marker_radii_px(dots);
    for (std::size_t i = 0; i < std::min(dots.x.size(), dots.y.size()); ++i) {
      if (!drawable(*frame.across, dots.x[i])) continue;
      if (i < dots.low.size() && i < dots.high.size())
        if (const auto part = shown(*frame.up, dots.low[i], dots.high[i]))
          cover(boxes, frame.at(dots.x[i], part->low), frame.at(dots.x[i], part->high),
                part->cut_low || part->cut_high ? kArrow_px : 1);
      if (!drawable(*frame.up, dots.y[i])) continue;
      const auto [x, y] = frame.at(dots.x[i], dots.y[i]);
      const double r = 1.3 * radii[i] + 0.8;
      boxes.push_back({x - r, y - r, x + r, y + r});
    }
  }
  void operator()(const Span& span) const {
    if (!drawable(*frame.up, span.at)) return;
    if (const auto part = shown(*frame.across, span.low, span.high))
      cover(boxes, frame.at(part->low, span.at), frame.at(part->high, span.at), kArrow_px);
  }
};

bool meet(double a_low, double a_high, double b_low, double b_high) {
  return a_low <= b_high && b_low <= a_high;
}

/// True if two series have an interval at the same place of the axis, and these overlap.
bool on_each_other(const Points& a, const Points& b, const Frame& frame) {
  const auto count = [](const Points& dots) {
    return std::min({dots.x.size(), dots.low.size(), dots.high.size()});
  };
  for (std::size_t i = 0; i < count(a); ++i)
    for (std::size_t j = 0; j < count(b); ++j) {
      if (!drawable(*frame.across, a.x[i]) || !drawable(*frame.across, b.x[j])) continue;
      const double apart_px = frame.at(a.x[i], 0).first - frame.at(b.x[j], 0).first;
      if (std::abs(apart_px) < kSamePlace_px && meet(a.low[i], a.high[i], b.low[j], b.high[j])) return true;
    }
  return false;
}

/// The smallest distance in px between different places of these points.
double closest_px(const std::vector<Points*>& all, const Frame& frame) {
  std::vector<double> places;
  for (const auto* dots : all)
    for (const double x : dots->x)
      if (drawable(*frame.across, x)) places.push_back(frame.at(x, 0).first);
  std::sort(places.begin(), places.end());
  double closest = frame.width;
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i] - places[i - 1] >= kSamePlace_px) closest = std::min(closest, places[i] - places[i - 1]);
  return closest;
}

void shift_along(std::vector<double>& x, const Axis& axis, double share) {
  for (double& value : x)
    value = axis.scale == AxisScale::linear ? value + share * (axis.high - axis.low)
                                            : value * std::pow(axis.high / axis.low, share);
}

/// True if a horizontal interval is that of one of these points.
bool belongs(const Span& span, const Points& dots) {
  return span.of_marker && span.series == dots.series &&
         std::find(dots.y.begin(), dots.y.end(), span.at) != dots.y.end();
}

void move_points(std::vector<Layer>& layers, const Frame& frame) {
  std::vector<Points*> all, clash;
  for (auto& layer : layers)
    if (auto* dots = std::get_if<Points>(&layer); dots != nullptr && !dots->low.empty()) all.push_back(dots);
  for (auto* dots : all)
    if (std::any_of(all.begin(), all.end(), [&](const Points* other) {
          return other != dots && on_each_other(*dots, *other, frame);
        }))
      clash.push_back(dots);
  if (clash.size() < 2) return;
  const auto count = static_cast<double>(clash.size());
  const double closest = closest_px(clash, frame);
  // between levels that are close to each other there is no room for the least distance
  const double least_px = closest < count * kLeastBeside_px ? 0 : kLeastBeside_px;
  const double step_px = std::clamp(0.6 * closest / count, least_px, kBeside_px);
  for (std::size_t i = 0; i < clash.size(); ++i) {
    const double share = (static_cast<double>(i) - (count - 1) / 2) * step_px / frame.width;
    for (auto& layer : layers)
      if (auto* line = std::get_if<Line>(&layer);
          line != nullptr && line->series == clash[i]->series && line->x == clash[i]->x)
        shift_along(line->x, *frame.across, share);
    for (auto& layer : layers)
      if (auto* span = std::get_if<Span>(&layer); span != nullptr && belongs(*span, *clash[i])) {
        std::vector<double> ends{span->low, span->high};
        shift_along(ends, *frame.across, share);
        span->low = ends[0], span->high = ends[1];
      }
    shift_along(clash[i]->x, *frame.across, share);
  }
}

/// Moves the point at this height, with its interval and the line through it.
template <typename Moved>
void move_point(std::vector<Layer>& layers, Points& dots, double height, const Moved& moved) {
  const auto i = static_cast<std::size_t>(std::find(dots.y.begin(), dots.y.end(), height) - dots.y.begin());
  for (auto& layer : layers)
    if (auto* line = std::get_if<Line>(&layer);
        line != nullptr && line->series == dots.series && line->x == dots.x && line->y[i] == height)
      line->y[i] = moved(height);
  for (auto* list : {&dots.y, &dots.low, &dots.high})
    if (i < list->size()) (*list)[i] = moved((*list)[i]);
}

void move_spans(std::vector<Layer>& layers, const Frame& frame) {
  std::vector<Span*> spans;
  for (auto& layer : layers)
    if (auto* span = std::get_if<Span>(&layer)) spans.push_back(span);
  std::vector<Span*> group;
  const auto height = [&](const Span* span) { return frame.at(frame.across->low, span->at).second; };
  std::sort(spans.begin(), spans.end(), [&](const Span* a, const Span* b) { return height(a) < height(b); });
  const auto spread = [&] {
    for (std::size_t i = 0; i < group.size() && group.size() > 1; ++i) {
      const double off_px =
          (static_cast<double>(i) - (static_cast<double>(group.size()) - 1) / 2) * kBeside_px;
      const auto moved = [&](double old) {
        std::vector<double> at{old};
        shift_along(at, *frame.up, -off_px / frame.height);
        return std::min(at.front(), std::max(old, frame.up->most));
      };
      for (auto& layer : layers)
        if (auto* dots = std::get_if<Points>(&layer); dots != nullptr && belongs(*group[i], *dots))
          move_point(layers, *dots, group[i]->at, moved);
      group[i]->at = moved(group[i]->at);
    }
    group.clear();
  };
  for (auto* span : spans) {
    const bool joins = std::any_of(group.begin(), group.end(), [&](const Span* other) {
      return std::abs(height(other) - height(span)) < kBeside_px &&
             meet(other->low, other->high, span->low, span->high);
    });
    if (!joins) spread();
    group.push_back(span);
  }
  spread();
}

/// Returns possible places for a label beside a rule, best place first.
std::vector<RuleLabel> places_beside(const Rule& rule, const Frame& frame) {
  std::vector<RuleLabel> places;
  const double right = frame.x + frame.width, bottom = frame.y + frame.height;
  if (is_flat(rule)) {
    const double y = frame.at(frame.across->low, rule.at).second;
    const double width = text_width(rule.label, kLabelText_px);
    for (double end = right - kBesideRule; end - width >= frame.x + kBesideRule; end -= 0.1 * frame.width)
      for (const double base : {y - kBesideRule, y + 1 + kAscent})
        places.push_back(label_at(rule, {end, base}, Anchor::end));
  } else {
    const auto [low, high] = ends_of(rule, frame);
    const double x = low.first;
    for (double base = high.second + 12; base + kDescent <= bottom; base += 0.25 * kRow) {
      places.push_back(label_at(rule, {x + kBesideRule, base}, Anchor::start));
      places.push_back(label_at(rule, {x - kBesideRule, base}, Anchor::end));
    }
  }
  // Remove places outside the frame. A label may extend 1 px above the upper edge of the frame.
  std::erase_if(places, [&](const RuleLabel& place) {
    return place.box.left < frame.x || place.box.right > right || place.box.top < frame.y - 1 ||
           place.box.bottom > bottom;
  });
  return places;
}

RuleLabel lower(RuleLabel label) {
  label.at.second += kRow;
  label.box.top += kRow;
  label.box.bottom += kRow;
  return label;
}

/// Returns the frame that remains for the data after space outside it was given to the labels of these rules.
Frame without_labels(Frame frame, const std::set<const Rule*>& rules) {
  double right = 0;
  for (const auto* rule : rules) {
    if (is_flat(*rule)) {
      right = std::max(right, kOver + 1 + text_width(rule->label, kLabelText_px));
    } else {
      frame.y += kRow;
      frame.height -= kRow;
    }
  }
  frame.width -= right;
  return frame;
}

/// Places a rule's label outside the data: above the data, in the given row, for a vertical rule; to the
/// right of the data for a horizontal rule.
RuleLabel outside(const Rule& rule, const Frame& frame, int row) {
  if (is_flat(rule)) {
    const auto at = frame.at(frame.across->high, rule.at);
    return label_at(rule, {frame.x + frame.width + kOver + 1, at.second + 4}, Anchor::start);
  }
  const double x = frame.at(rule.at, frame.up->low).first;
  const double half = std::min(0.5 * text_width(rule.label, kLabelText_px), 0.5 * frame.width);
  return label_at(
      rule,
      {std::clamp(x, frame.x + half, frame.x + frame.width - half), frame.y - kOver - kDescent - kRow * row},
      Anchor::middle);
}

}  // namespace

Point Frame::at(double value_x, double value_y) const {
  return {x + std::clamp(position(*across, value_x), -4.0, 5.0) * width,
          y + (1 - std::clamp(position(*up, value_y), -4.0, 5.0)) * height};
}

bool drawable(const Axis& axis, double value) {
  return std::isfinite(value) && (axis.scale == AxisScale::linear || value > 0);
}

std::optional<Shown> shown(const Axis& axis, double low, double high) {
  if (std::isnan(low) || std::isnan(high)) return std::nullopt;
  const auto place = [&axis](double value) {
    return axis.scale == AxisScale::log10 && value <= 0 ? -1.0 : position(axis, value);
  };
  constexpr double rounding = 1e-9;
  if (place(low) > 1 + rounding || place(high) < -rounding) return std::nullopt;
  return Shown{std::max(low, axis.low), std::min(high, axis.high), place(low) < -rounding,
               place(high) > 1 + rounding};
}

std::vector<Layer> beside(const Chart& chart, const Frame& frame) {
  auto layers = chart.layers;
  if (!chart.beside || frame.width <= 0 || frame.height <= 0) return layers;
  move_points(layers, frame);
  move_spans(layers, frame);
  return layers;
}

std::vector<double> marker_radii_px(const Points& dots) {
  constexpr double least = 2.4, span = 2.4;
  if (dots.weight.size() != dots.x.size()) return std::vector<double>(dots.x.size(), least + 0.5 * span);
  std::vector<double> radii;
  const auto heaviest = std::max_element(dots.weight.begin(), dots.weight.end());
  for (const double weight : dots.weight) radii.push_back(least + span * std::sqrt(weight / *heaviest));
  return radii;
}

bool overlap(const Box& a, const Box& b) {
  constexpr double touching = 1e-6;
  return a.left < b.right - touching && b.left < a.right - touching && a.top < b.bottom - touching &&
         b.top < a.bottom - touching;
}

std::pair<Point, Point> ends_of(const Rule& rule, const Frame& frame) {
  if (is_flat(rule)) return {frame.at(frame.across->low, rule.at), frame.at(frame.across->high, rule.at)};
  const double top = rule.until ? std::min(*rule.until, frame.up->high) : frame.up->high;
  return {frame.at(rule.at, frame.up->low), frame.at(rule.at, top)};
}

bool is_shown(const Rule& rule, const Frame& frame) {
  const Axis& axis = is_flat(rule) ? *frame.up : *frame.across;
  if (!drawable(axis, rule.at)) return false;
  const double place = position(axis, rule.at);
  return place > -1e-9 && place < 1 + 1e-9;
}

Box drawn_in(const Frame& frame) {
  return {frame.x - 1, frame.y - kOver, frame.x + frame.width + kOver, frame.y + frame.height + 1};
}

std::vector<Box> covered(const Chart& chart, const Frame& frame) {
  std::vector<Box> boxes;
  for (const auto& layer : chart.layers) std::visit(Cover{boxes, frame}, layer);
  const auto clip = drawn_in(frame);
  std::erase_if(boxes, [&](const Box& box) { return !overlap(box, clip); });
  for (auto& box : boxes)
    box = {std::max(box.left, clip.left), std::max(box.top, clip.top), std::min(box.right, clip.right),
           std::min(box.bottom, clip.bottom)};
  return boxes;
}

Labelled place_labels(const Chart& chart, Frame whole, VerticalLabels where, const std::vector<Tick>& grid) {
  std::set<const Rule*> outside_data;
  for (const auto& layer : chart.layers)
    if (const auto* rule = std::get_if<Rule>(&layer);
        rule != nullptr && !rule->label.empty() && !is_flat(*rule) && where == VerticalLabels::above)
      outside_data.insert(rule);
  for (;;) {
    const auto frame = without_labels(whole, outside_data);
    auto boxes = covered(chart, frame);
    for (const auto& tick : grid) {
      const double y = frame.at(frame.across->low, tick.value).second;
      boxes.push_back({frame.x, y - 0.5, frame.x + frame.width, y + 0.5});
    }
    Labelled result{frame, {}};
    const auto free = [&](const RuleLabel& place) {
      return std::none_of(boxes.begin(), boxes.end(),
                          [&](const Box& box) { return overlap(box, place.box); }) &&
             std::none_of(result.labels.begin(), result.labels.end(),
                          [&](const RuleLabel& other) { return overlap(other.box, place.box); });
    };
    bool all = true;
    // the label of the first rule is the uppermost
    int rows =
        static_cast<int>(std::count_if(outside_data.begin(), outside_data.end(), [&](const Rule* rule) {
          return !is_flat(*rule) && is_shown(*rule, frame);
        }));
    for (const auto& layer : chart.layers) {
      const auto* rule = std::get_if<Rule>(&layer);
      if (rule == nullptr || rule->label.empty() || !is_shown(*rule, frame)) continue;
      if (outside_data.count(rule) > 0) {
        auto label = outside(*rule, frame, is_flat(*rule) ? 0 : --rows);
        while (!free(label)) label = lower(std::move(label));
        result.labels.push_back(std::move(label));
        continue;
      }
      const auto places = places_beside(*rule, frame);
      const auto found = std::find_if(places.begin(), places.end(), free);
      if (found != places.end()) {
        result.labels.push_back(*found);
      } else {
        outside_data.insert(rule);
        all = false;
      }
    }
    if (all) return result;
  }
}

}  // namespace turnpoint::report
