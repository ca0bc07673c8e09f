#pragma once
#include <string>

namespace turnpoint::plot {

enum class Marker { circle, square, triangle, diamond, down, cross };

/// How a series looks: three marks that each tell it apart without the others.
struct Style {
  std::string colour, dash;
  Marker marker = Marker::circle;
};

/// Of series 0, 1, ... (wrapping at 6), or grey for a negative number. Colours: Okabe & Ito (2008), without
/// their yellow, which is too light for thin lines on paper.
Style style(int series);

/// A colour of the sequential scale, light (0) to dark (1) blue, of falling luminance.
std::string shade(double share);

}  // namespace turnpoint::plot
