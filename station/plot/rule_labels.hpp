#pragma once
#include <vector>

#include "station/plot/chart.hpp"
#include "station/plot/svg.hpp"

namespace turnpoint::plot {

/// Where a panel's data rectangle lies in px, and what its axes show.
struct Frame {
  double x = 0, y = 0, width = 0, height = 0;
  const Axis *across, *up;

  /// Far outside of the axes it stays within a few widths of the panel.
  Svg::Point at(double value_x, double value_y) const;
};

/// False for what has no place on the axis: not finite, or not positive on a log axis.
bool drawable(const Axis& axis, double value);

/// False for a rule beyond the panel's axes.
bool is_shown(const Rule& rule, const Frame& frame);

/// Nominal radii in px of markers, by their weights; no marker reaches further than 1.3 radii and its
/// outline.
std::vector<double> marker_radii_px(const Points& dots);

/// Size of a rule's label.
constexpr double kLabelText_px = 11;

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};
bool overlap(const Box& a, const Box& b);

/// Nothing of the data is drawn outside of this: markers at the upper and right end reach over the frame.
Box drawn_in(const Frame& frame);

/// What the panel's curves, markers, bars, cells and rules cover, in small boxes. Bands do not count: they
/// let text show through.
std::vector<Box> covered(const Panel& panel, const Frame& frame);

/// A rule's label as it stands: a baseline's end, and the box that the text keeps within.
struct RuleLabel {
  std::string text;
  Svg::Point at;
  Anchor anchor = Anchor::start;
  Box box;
};

/// The labels of the panel's rules, and the frame that they leave. Each stands beside its rule where nothing
/// is covered, as near to the upper right end as it can. One that finds no such place goes out of the data:
/// a vertical rule's above it, in a row of its own, a horizontal one's to the right; the frame gets smaller
/// by that. `above`: vertical rules' labels all go there, so that panels side by side stay of one height.
struct Labelled {
  Frame frame;
  std::vector<RuleLabel> labels;
};
enum class VerticalLabels { beside, above };
Labelled place_labels(const Panel& panel, Frame frame, VerticalLabels where = VerticalLabels::beside);

}  // namespace turnpoint::plot
