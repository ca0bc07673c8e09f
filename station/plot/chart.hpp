#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "station/plot/axis.hpp"
#include "station/plot/canvas.hpp"

namespace turnpoint::plot {

/// A series is identified by number. Each has its own colour (Okabe & Ito's, safe for colour-blind readers),
/// dash and marker, so that a legend never depends on colour alone. Numbers wrap at 6; kNeutral is grey.
constexpr int kNeutral = -1;

/// A curve. Points that are not finite interrupt it.
struct Line {
  std::vector<double> x, y;
  int series = 0;
  std::string name;  ///< name in the legend; "" leaves it out
};

/// Markers, with vertical error bars if `low` and `high` are given (one value per point). `weight` scales the
/// area of each marker (its number of trials); markers are open if `open` says so (wrong answers).
struct Points {
  std::vector<double> x, y, low, high, weight;
  std::vector<bool> open;
  int series = 0;
  std::string name;
};

/// The area between two curves.
struct Band {
  std::vector<double> x, low, high;
  int series = 0;
  std::string name;
};

/// Bars from 0 between `edges` (one more edge than heights).
struct Histogram {
  std::vector<double> edges, heights;
  int series = 0;
  std::string name;
};

/// A grid of values, row by row from the low y edge, with one more edge than cells in each direction. Colours
/// go from light to dark blue over [low, high]; values that are not finite stay empty.
struct HeatMap {
  std::vector<double> x_edges, y_edges, values;
  double low = 0, high = 1;
  std::string name;  ///< label of the colour bar
};

/// A thin dashed line across the chart with a small label: chance, a deadline, a threshold.
struct Rule {
  enum class Direction { horizontal, vertical } direction = Direction::horizontal;
  double at = 0;
  std::string label;
};

using Layer = std::variant<Band, Histogram, HeatMap, Rule, Line, Points>;

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Layer> layers;  ///< in drawing order
};

/// One picture: charts in rows of `columns` (small multiples).
struct Figure {
  std::string title;  ///< the document's title, and a description for readers who cannot see the figure
  std::vector<Chart> charts;
  int columns = 1;
  double chart_width_px = 420, chart_height_px = 300;
  std::string caption;  ///< text below the charts, broken into lines; "" leaves it out
};

/// Throws std::invalid_argument for lists of different lengths, axes without a range, a figure without
/// charts, and before anything is drawn if a chart leaves no room for its data.
void draw(Canvas& canvas, const Figure& figure);

/// The figure as an SVG document. The same figure always gives the same bytes.
std::string render(const Figure& figure);

/// The figure laid out for a document of this size, with the number of columns that gives its charts the best
/// proportions. If there is not enough room, the document becomes larger than requested, in the same
/// proportions; text keeps its size.
Figure laid_out(Figure figure, double width_px, double height_px);

/// Counts of `values` in at most `bins` equal bins between the rounded ends of their range.
Histogram histogram(const std::vector<double>& values, double low, double high, int bins);

}  // namespace turnpoint::plot
