#include "station/report/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace turnpoint::report {

Style style(int series) {
  static const std::array<Style, 6> styles{{{"#0072b2", "", Marker::circle},
                                            {"#d55e00", "7 3", Marker::square},
                                            {"#009e73", "2 3", Marker::triangle},
                                            {"#cc79a7", "9 3 2 3", Marker::diamond},
                                            {"#56b4e9", "5 2 2 2 2 2", Marker::down},
                                            {"#e69f00", "12 4", Marker::cross}}};
  if (series < 0) return {"#555555", "", Marker::circle};
  return styles[static_cast<std::size_t>(series) % styles.size()];
}

std::string shade(double share) {
  constexpr std::array<std::array<double, 3>, 4> stops{
      {{247, 251, 255}, {158, 202, 225}, {49, 130, 189}, {8, 40, 95}}};
  const double place = std::clamp(share, 0.0, 1.0) * 3;
  const auto below = std::min(static_cast<std::size_t>(place), std::size_t{2});
  const double part = place - static_cast<double>(below);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<int>(std::lround(stops[below][i] + part * (stops[below + 1][i] - stops[below][i])));
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
  return buffer;
}

}  // namespace turnpoint::report
