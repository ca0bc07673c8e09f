#pragma once
#include <optional>
#include <vector>

#include "station/report/canvas.hpp"
#include "station/report/chart.hpp"

namespace turnpoint::report {

/// The data rectangle of a chart in px, and its axes.
struct Frame {
  double x = 0, y = 0, width = 0, height = 0;
  const Axis *across, *up;

  /// Returns the position of a data point in px. A point far outside the axes is moved closer, to a distance
  /// of a few chart widths.
  Point at(double value_x, double value_y) const;
};

/// False if the value has no position on the axis: it is not finite, or not positive on a log axis.
bool drawable(const Axis& axis, double value);

/// The part of an interval that an axis shows, and which of its ends lie beyond the axis.
struct Shown {
  double low = 0, high = 0;
  bool cut_low = false, cut_high = false;
};
/// Returns the shown part of an interval; nullopt if the axis shows nothing of it, or an end is not a number.
std::optional<Shown> shown(const Axis& axis, double low, double high);

/// Moves intervals of several series that would lie on each other beside each other: those of points to the
/// side, those of a Span up and down. A line through the same points moves with them, and so do both
/// intervals of a point.
std::vector<Layer> beside(const Chart& chart, const Frame& frame);

/// The two ends of a rule in px.
std::pair<Point, Point> ends_of(const Rule& rule, const Frame& frame);

/// False if the rule lies outside the chart's axes.
bool is_shown(const Rule& rule, const Frame& frame);

/// Returns the nominal radii of markers in px from their weights. Including its outline, a marker extends at
/// most 1.3 radii plus the outline's width from its centre.
std::vector<double> marker_radii_px(const Points& dots);

constexpr double kLabelText_px = 11;

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};
bool overlap(const Box& a, const Box& b);

/// Returns the area in which the data are drawn. It is larger than the frame, because markers at the upper
/// and right edge extend beyond the frame.
Box drawn_in(const Frame& frame);

/// Returns small boxes that cover the chart's curves, markers, bars, cells and rules. Bands are left out,
/// because text on them remains readable.
std::vector<Box> covered(const Chart& chart, const Frame& frame);

/// The label of a rule after it was placed: the anchor point of its baseline, and the box around its text.
struct RuleLabel {
  std::string text;
  Point at;
  Anchor anchor = Anchor::start;
  Box box;
  int series = kNeutral;
};

/// The labels of the chart's rules (reference lines), and the frame that remains for the data. A label stands
/// beside its rule, in the free place nearest to the upper right end. If no place is free, the label goes
/// outside the data, and the frame becomes smaller: the label of a vertical rule then stands above the data
/// in a separate row, that of a horizontal rule to the right. `above` puts the labels of all vertical rules
/// above the data, so that charts side by side keep the same height.
struct Labelled {
  Frame frame;
  std::vector<RuleLabel> labels;
};
enum class VerticalLabels { beside, above };
/// `grid` contains the values at which lines cross the whole chart; labels stand between them.
Labelled place_labels(const Chart& chart, Frame frame, VerticalLabels where = VerticalLabels::beside,
                      const std::vector<Tick>& grid = {});

}  // namespace turnpoint::report
