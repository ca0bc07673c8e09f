#pragma once
#include <functional>
#include <string>
#include <vector>

#include "station/report/chart.hpp"

namespace turnpoint::report {

/// A figure of a report, and the name under which it is saved, such as "psychometric-function".
struct NamedFigure {
  std::string name;
  Figure figure;
};
/// The data of a figure as CSV: a row for each point, bar, cell, rule and interval, with the chart, its axes
/// and the series it belongs to. A value that does not exist is an empty cell.
std::string data_csv(const Figure& figure);

/// A file of a saved figure.
struct FigureFile {
  std::string name, bytes;
};
/// The files of a figure for a paper: NAME-1-column.svg and .pdf, 85 mm wide, NAME-2-columns.svg and .pdf,
/// 180 mm wide, NAME.csv with its data and NAME.txt with its caption. Letters are 8 or 9 points high at that
/// size. `pdf_of` makes a PDF document; if it returns "", there is none.
using PdfOf = std::function<std::string(const Figure& figure)>;
std::vector<FigureFile> figure_files(const NamedFigure& figure, const PdfOf& pdf_of);

/// Lays a figure out for the width of a column or a page, without its caption. Up to 18 charts fit on a page
/// of 230 mm.
Figure for_paper(Figure figure, double width_mm);
constexpr double kOneColumn_mm = 85, kTwoColumns_mm = 180;

}  // namespace turnpoint::report
