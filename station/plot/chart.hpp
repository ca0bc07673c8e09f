#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "station/plot/axis.hpp"

namespace turnpoint::plot {

/// Series are told apart by number: each has a colour (Okabe & Ito's, safe for colour-blind readers), a dash
/// and a marker of its own, so that a legend never rests on colour alone. Numbers wrap at 6; kNeutral is
/// grey.
constexpr int kNeutral = -1;

/// A curve; points that are not finite break it.
struct Line {
  std::vector<double> x, y;
  int series = 0;
  std::string name;  ///< in the legend; "" leaves it out
};

/// Markers with vertical error bars where `low` and `high` are given (then as many as points). `weight`
/// scales the area of each marker (trials behind it); open markers where `open` says so (wrong answers).
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

/// Bars from 0 between `edges` (one more than heights).
struct Histogram {
  std::vector<double> edges, heights;
  int series = 0;
  std::string name;
};

/// A grid of values, row by row from the low y edge; edges one more than cells. Colours go from light to dark
/// blue over [low, high]; values that are not finite stay empty.
struct HeatMap {
  std::vector<double> x_edges, y_edges, values;
  double low = 0, high = 1;
  std::string name;  ///< of the colour bar
};

/// A thin dashed line across the panel with a small label: chance, a deadline, a threshold.
struct Rule {
  enum class Direction { horizontal, vertical } direction = Direction::horizontal;
  double at = 0;
  std::string label;
};

using Layer = std::variant<Band, Histogram, HeatMap, Rule, Line, Points>;

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Layer> layers;  ///< drawn in this order
};

/// One picture: panels side by side in rows of `columns` (small multiples).
struct Figure {
  std::string title;  ///< for readers who cannot see it, and the document's title
  std::vector<Panel> panels;
  int columns = 1;
  double panel_width_px = 420, panel_height_px = 300;
  std::string caption;  ///< below the panels, broken into lines; "" leaves it out
};

/// The SVG document; the same figure gives the same bytes. Throws std::invalid_argument for lists whose
/// lengths do not agree, axes without a range, or no panel.
std::string render(const Figure& figure);

/// The figure laid out for a document of this size: as many columns as give its panels the best proportions.
/// Where there is no room the document is larger than asked for, in the same proportions; text keeps its
/// size.
Figure laid_out(Figure figure, double width_px, double height_px);

/// Counts of `values` in equal bins between the nice ends of their range; at most `bins`.
Histogram histogram(const std::vector<double>& values, double low, double high, int bins);

}  // namespace turnpoint::plot
