#include "station/report/rule_labels.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace turnpoint::report {

namespace {

constexpr double kAscent = 9.5, kDescent = 3, kRow = 13, kBesideRule = 4;
constexpr double kOver = 6;  // how far lines and markers may extend beyond the frame, in px

Box box_of(const std::string& text, Point at, Anchor anchor) {
  const double width = text_width(text, kLabelText_px);
  const double left = at.first - width * (anchor == Anchor::start ? 0 : anchor == Anchor::middle ? 0.5 : 1);
  return {left, at.second - kAscent, left + width, at.second + kDescent};
}

RuleLabel label_at(const Rule& rule, Point at, Anchor anchor) {
  return {rule.label, at, anchor, box_of(rule.label, at, anchor)};
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
    if (is_flat(rule))
      cover(boxes, frame.at(frame.across->low, rule.at), frame.at(frame.across->high, rule.at), 0.5);
    else
      cover(boxes, frame.at(rule.at, frame.up->low), frame.at(rule.at, frame.up->high), 0.5);
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
      if (i < dots.low.size() && i < dots.high.size() && drawable(*frame.up, dots.low[i]) &&
          drawable(*frame.up, dots.high[i]))
        cover(boxes, frame.at(dots.x[i], dots.low[i]), frame.at(dots.x[i], dots.high[i]), 1);
      if (!drawable(*frame.up, dots.y[i])) continue;
      const auto [x, y] = frame.at(dots.x[i], dots.y[i]);
      const double r = 1.3 * radii[i] + 0.8;
      boxes.push_back({x - r, y - r, x + r, y + r});
    }
  }
};

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
    const double x = frame.at(rule.at, frame.up->low).first;
    for (double base = frame.y + 12; base + kDescent <= bottom; base += 0.5 * kRow) {
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

Labelled place_labels(const Chart& chart, Frame whole, VerticalLabels where) {
  std::set<const Rule*> outside_data;
  for (const auto& layer : chart.layers)
    if (const auto* rule = std::get_if<Rule>(&layer);
        rule != nullptr && !rule->label.empty() && !is_flat(*rule) && where == VerticalLabels::above)
      outside_data.insert(rule);
  for (;;) {
    const auto frame = without_labels(whole, outside_data);
    const auto boxes = covered(chart, frame);
    Labelled result{frame, {}};
    const auto free = [&](const RuleLabel& place) {
      return std::none_of(boxes.begin(), boxes.end(),
                          [&](const Box& box) { return overlap(box, place.box); }) &&
             std::none_of(result.labels.begin(), result.labels.end(),
                          [&](const RuleLabel& other) { return overlap(other.box, place.box); });
    };
    bool all = true;
    int rows = 0;
    for (const auto& layer : chart.layers) {
      const auto* rule = std::get_if<Rule>(&layer);
      if (rule == nullptr || rule->label.empty() || !is_shown(*rule, frame)) continue;
      if (outside_data.count(rule) > 0) {
        auto label = outside(*rule, frame, is_flat(*rule) ? 0 : rows++);
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
