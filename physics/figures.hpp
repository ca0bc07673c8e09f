#pragma once
// The curves of the 1998 paper's Figures 3, 5, 8 and 10, with the corrected theory beside them; drawing is
// elsewhere.
#include <string>
#include <vector>

namespace turnpoint::physics {

struct Curve {
  std::string label;
  std::vector<double> x_mm;
  std::vector<double> value;  // displacement, last maximum at one
};

struct Mark {
  std::string label;
  double x_mm = 0;
};

// One pair of axes.
struct FigurePanel {
  std::string title;
  std::string y_label;
  std::vector<Curve> curves;  // all at the same points
  std::vector<Mark> marks;    // turning points
};

struct Figure {
  std::string id;  // "figure-3", ... (also the file's name)
  std::string title;
  std::string x_label;
  std::string note;  // what was fitted, and what differs from the paper
  std::vector<FigurePanel> panels;
};

// Figure 3: 19.6 kHz on the brass membrane; 5: 20 and 40 kHz; 8: a rubber membrane at 30 and 40 Hz (its
// tension is not published: it is fitted to the turning point read from the figure); 10: 8 and 45 kHz, alone
// and together. Curves are lossless shapes with the last maximum at one: the flux-corrected mode, the
// seed's equation 11 solved exactly, and its Airy profile (eqs. 20-22); together is the root of summed
// squares.
std::vector<Figure> figures();

// A figure's curves as comma-separated values: x_mm, then one column a curve, headed "panel: curve".
std::string to_csv(const Figure& figure);

}  // namespace turnpoint::physics
