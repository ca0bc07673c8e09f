#pragma once
#include <string>

namespace turnpoint::report {

enum class Marker { circle, square, triangle, diamond, down, cross };

/// The look of a series. Each of the three properties alone identifies the series.
struct Style {
  std::string colour, dash;
  Marker marker = Marker::circle;
};

/// Returns the style of series 0, 1, ... (repeating after 6), or grey for a negative number. The colours are
/// those of Okabe & Ito (2008) without their yellow, which is too light for thin lines on paper.
Style style(int series);

/// Returns a blue between light (share 0) and dark (share 1). A larger share gives a lower luminance.
std::string shade(double share);

}  // namespace turnpoint::report
