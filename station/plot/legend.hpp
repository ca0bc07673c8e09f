#pragma once
#include <string>
#include <vector>

#include "station/plot/canvas.hpp"
#include "station/plot/chart.hpp"
#include "station/plot/palette.hpp"

namespace turnpoint::plot {

constexpr double kText_px = 12;
inline const std::string kInk = "#222222";  ///< colour of text and axes

/// Draws the style's marker, filled or open, with a nominal radius in px (see marker_radii_px).
void marker(Canvas& canvas, Point at, double radius, const Style& style, bool open);

/// One entry of the legend. Layers with the same name and series share one entry.
struct LegendEntry {
  std::string name;
  int series = 0;
  bool line = false, points = false, open_points = false, area = false;
};

/// Returns an entry for each layer of the chart that has a name.
std::vector<LegendEntry> legend_of(const Chart& chart);

/// Draws the legend between title and data, in rows that fit the width (px). Returns its height in px.
/// Without a canvas it draws nothing.
double draw_legend(Canvas* canvas, const std::vector<LegendEntry>& entries, double left, double top,
                   double width);

}  // namespace turnpoint::plot
