#pragma once
#include <vector>

#include "station/plot/canvas.hpp"
#include "station/plot/chart.hpp"

namespace turnpoint::plot {

/// The data rectangle of a chart in px, and its axes.
struct Frame {
  double x = 0, y = 0, width = 0, height = 0;
  const Axis *across, *up;

  /// Points far outside the axes are kept within a few widths of the chart.
  Point at(double value_x, double value_y) const;
};

/// False for a value without a position on the axis: not finite, or not positive on a log axis.
bool drawable(const Axis& axis, double value);

/// False for a rule beyond the chart's axes.
bool is_shown(const Rule& rule, const Frame& frame);

/// Nominal radii of markers in px, from their weights. No marker extends further than 1.3 radii plus its
/// outline.
std::vector<double> marker_radii_px(const Points& dots);

/// Size of a rule's label.
constexpr double kLabelText_px = 11;

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};
bool overlap(const Box& a, const Box& b);

/// The area outside of which no data are drawn. Markers at the upper and right end extend beyond the frame.
Box drawn_in(const Frame& frame);

/// The area covered by the chart's curves, markers, bars, cells and rules, as small boxes. Bands are ignored,
/// because text remains readable on them.
std::vector<Box> covered(const Chart& chart, const Frame& frame);

/// A placed label of a rule: the end of its baseline, and the box around its text.
struct RuleLabel {
  std::string text;
  Point at;
  Anchor anchor = Anchor::start;
  Box box;
};

/// The labels of the chart's rules, and the frame that is left for the data. Each label is placed beside its
/// rule where nothing is covered, as near to the upper right end as possible. If there is no such place, it
/// goes outside the data, and the frame becomes smaller: above it for a vertical rule (in a row of its own),
/// to the right for a horizontal one. With `above`, the labels of all vertical rules go there, so that charts
/// side by side keep the same height.
struct Labelled {
  Frame frame;
  std::vector<RuleLabel> labels;
};
enum class VerticalLabels { beside, above };
Labelled place_labels(const Chart& chart, Frame frame, VerticalLabels where = VerticalLabels::beside);

}  // namespace turnpoint::plot
