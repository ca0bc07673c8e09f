#pragma once
#include <string>

namespace turnpoint::plot {

enum class Marker { circle, square, triangle, diamond, down, cross };

/// The look of a series. Each of the three properties alone identifies it.
struct Style {
  std::string colour, dash;
  Marker marker = Marker::circle;
};

/// The style of series 0, 1, ... (wrapping at 6), or grey for a negative number. Colours: Okabe & Ito (2008),
/// without their yellow, which is too light for thin lines on paper.
Style style(int series);

/// A colour of the sequential scale from light (0) to dark (1) blue, with decreasing luminance.
std::string shade(double share);

}  // namespace turnpoint::plot
