#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "station/report/axis.hpp"
#include "station/report/canvas.hpp"

namespace turnpoint::report {

/// Data series are numbered. Each number has its own colour (Okabe & Ito, safe for colour-blind readers),
/// dash and marker, so that readers can match the legend without seeing colours. After 6 series the styles
/// repeat; kNeutral is grey.
constexpr int kNeutral = -1;

/// A curve. A point that is not finite leaves a gap.
struct Line {
  std::vector<double> x, y;
  int series = 0;
  std::string name;     ///< name in the legend; "" leaves it out
  bool faint = false;   ///< true for one of many curves, such as a participant's behind the group's
  bool beyond = false;  ///< true for the part of a curve beyond the data: it is thin and dashed
};

/// Markers. If `low` and `high` are given (one value per point), each marker has a vertical error bar.
/// `weight`, such as a number of trials, scales the area of each marker. If `open` is given, it says which
/// markers are open, such as those of wrong answers.
struct Points {
  std::vector<double> x, y, low, high, weight;
  std::vector<bool> open;
  int series = 0;
  std::string name;

  /// Adds a marker with an error bar.
  void add(double at, double height, double from, double to) {
    x.push_back(at), y.push_back(height);
    low.push_back(from), high.push_back(to);
  }
};

/// A horizontal interval at one height, such as that of a threshold, with a stroke at each end.
struct Span {
  double low = 0, high = 0, at = 0;
  int series = 0;
  bool of_marker = false;  ///< the interval of a marker of its series at this height
};

/// The area between two curves.
struct Band {
  std::vector<double> x, low, high;
  int series = 0;
  std::string name;
};

/// Bars that start at 0. There is one more edge than there are heights.
struct Histogram {
  std::vector<double> edges, heights;
  int series = 0;
  std::string name;
};

/// A grid of coloured cells. `values` are listed row by row, starting at the lowest y. In each direction
/// there is one more edge than there are cells. The colours run from light blue at `low` to dark blue at
/// `high`. Cells whose value is not finite stay empty.
struct HeatMap {
  std::vector<double> x_edges, y_edges, values;
  double low = 0, high = 1;
  std::string name;  ///< label of the colour bar
};

/// A thin dashed line across the chart with a small label, for example at the chance level, a deadline or a
/// threshold. That of one series has its colour.
struct Rule {
  enum class Direction { horizontal, vertical } direction = Direction::horizontal;
  double at = 0;
  std::string label;
  int series = kNeutral;
  std::optional<double> until =
      {};  ///< of a vertical rule: the height at which it ends, such as that of a curve
};

using Layer = std::variant<Band, Histogram, HeatMap, Rule, Line, Points, Span>;

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Layer> layers;  ///< drawn one over another, the first at the bottom
  /// Whether intervals of several series that would lie on each other are drawn beside each other. The
  /// distance is a few px, the same for all points of a series.
  bool beside = true;
};

/// A figure of one or more charts, arranged in rows of `columns` charts. Charts below each other that have
/// the same horizontal axis show its labels once, below them; charts beside each other that have the same
/// vertical axis show its labels once, at the left. A legend that is the same for all charts stands once,
/// above them.
struct Figure {
  std::string title;  ///< title of the document; screen readers read it aloud
  std::vector<Chart> charts;
  int columns = 1;
  double chart_width_px = 420, chart_height_px = 300;
  std::string caption;  ///< text below the charts, broken into lines; "" for none
};

/// True if intervals of the figure that would lie on each other are drawn beside each other.
bool has_moved(const Figure& figure);

/// The largest number of columns, up to three, in which the charts leave the fewest places empty, and in
/// which their titles and axes have room within a width (px).
int columns_for(const Figure& figure, double width_px);

/// Arranges charts of a page, whose width they fill.
Figure on_page(Figure figure, double chart_height_px);

/// The height of the lowest data area of the figure, in px.
double least_data_px(const Figure& figure);

/// Draws the figure. Where an axis cuts an interval, an arrow points to the end that is not shown. A legend
/// appears only if there are several entries. Throws std::invalid_argument for lists of different lengths,
/// axes without a range, or a figure without charts. If a chart leaves no room for its data, it throws before
/// anything is drawn.
void draw(Canvas& canvas, const Figure& figure);

/// Returns the figure as an SVG document. The same figure always gives the same bytes.
std::string render(const Figure& figure);

/// The height of the caption below the charts, and the size of the whole figure, in px.
double caption_height_px(const Figure& figure);
Point size_px(const Figure& figure);

/// Returns the figure laid out for a document of this size. The number of columns is chosen so that the
/// charts have the best proportions. Text is never made smaller: if there is not enough room, the document
/// becomes larger and keeps its proportions.
Figure laid_out(Figure figure, double width_px, double height_px);
/// The same for a view of this size that can be scrolled downwards. The figure has the view's width, so that
/// text keeps its size: charts that have no room side by side stand below each other, each about as high as
/// the view, and a long caption stands below them.
Figure laid_out_to_scroll(Figure figure, double width_px, double height_px);

/// Counts `values` in at most `bins` bins of equal width. The bins reach from `low` to `high`, rounded
/// outwards.
Histogram histogram(const std::vector<double>& values, double low, double high, int bins);

}  // namespace turnpoint::report
