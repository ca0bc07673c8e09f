#pragma once
// Computes the curves of Figures 3, 5, 8 and 10 of the 1998 paper and, for comparison, those of the corrected
// theory. The caller draws them.
#include <string>
#include <vector>

namespace turnpoint::physics {

struct Curve {
  std::string label;
  std::vector<double> x_mm;
  std::vector<double> value;  // displacement divided by its last maximum
};

struct Mark {
  std::string label;
  double x_mm = 0;
};

// One pair of axes with its curves.
struct FigurePanel {
  std::string title;
  std::string y_label;
  std::vector<Curve> curves;  // all curves of a panel have the same x values
  std::vector<Mark> marks;    // the turning points of the tones
};

struct Figure {
  std::string id;  // such as "figure-3"; also the name of the figure's file
  std::string title;
  std::string x_label;
  std::string note;  // says what was fitted, and what differs from the paper
  std::vector<FigurePanel> panels;
};

// Figure 3: 19.6 kHz on the brass membrane. Figure 5: 20 and 40 kHz on the same membrane. Figure 8: a rubber
// membrane at 30 and 40 Hz, whose unpublished tension is fitted to the turning point in the figure. Figure
// 10: the brass membrane at 8 and 45 kHz, alone and together. Each curve is a shape without loss, scaled to
// one at the last maximum. Each panel shows the flux-corrected mode, the paper's equation 11 solved exactly,
// and the paper's Airy profile (eqs. 20-22). Two tones together are drawn as the root of summed squares.
std::vector<Figure> figures();

// A figure's curves as comma-separated values: x_mm, then one column per curve with the heading "panel:
// curve".
std::string to_csv(const Figure& figure);

}  // namespace turnpoint::physics
