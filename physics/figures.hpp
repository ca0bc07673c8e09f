#pragma once
// The curves of Figures 3, 5, 8 and 10 of the 1998 paper, together with the corrected theory. Drawing is done
// elsewhere.
#include <string>
#include <vector>

namespace turnpoint::physics {

struct Curve {
  std::string label;
  std::vector<double> x_mm;
  std::vector<double> value;  // displacement divided by the last maximum
};

struct Mark {
  std::string label;
  double x_mm = 0;
};

// One pair of axes with its curves.
struct FigurePanel {
  std::string title;
  std::string y_label;
  std::vector<Curve> curves;  // curves, all at the same points
  std::vector<Mark> marks;    // marks at the turning points
};

struct Figure {
  std::string id;  // such as "figure-3"; also the name of the figure's file
  std::string title;
  std::string x_label;
  std::string note;  // a note on what was fitted, and on what differs from the paper
  std::vector<FigurePanel> panels;
};

// Figure 3: 19.6 kHz on the brass membrane; 5: 20 and 40 kHz; 8: a rubber membrane at 30 and 40 Hz, whose
// tension is not published but fitted to the turning point in the figure; 10: 8 and 45 kHz, alone and
// together. Curves are shapes without loss, with the last maximum at one: the flux-corrected mode, the
// paper's equation 11 solved exactly, and its Airy profile (eqs. 20-22). Two tones together are the root of
// summed squares.
std::vector<Figure> figures();

// A figure's curves as comma-separated values: x_mm, then one column per curve with the heading "panel:
// curve".
std::string to_csv(const Figure& figure);

}  // namespace turnpoint::physics
