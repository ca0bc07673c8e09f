#pragma once
#include <string>
#include <vector>

namespace turnpoint::plot {

enum class AxisScale { linear, log10 };

/// What one axis of a chart shows.
struct Axis {
  std::string label;  ///< includes the unit: "Friction contrast (dB)"
  double low = 0, high = 1;
  AxisScale scale = AxisScale::linear;
};

struct Tick {
  double value = 0;
  std::string label;
};

/// About `wanted` ticks at 1, 2 or 5 times a power of ten, with as many decimals as the step needs. On a
/// log10 axis: 1, 2, 5 of each decade, or only decades if there are many, written as powers of ten and partly
/// without labels. Throws std::invalid_argument unless low < high, both limits are finite, and both are
/// positive on a log10 axis.
std::vector<Tick> ticks(const Axis& axis, int wanted = 6);

/// Position along the axis: 0 at the low end, 1 at the high end.
double position(const Axis& axis, double value);

/// An axis with limits that include all finite values (for log10: positive ones) and a margin of `margin`
/// times their range. If there are fewer than two different values, adds room around them.
Axis fitted(std::string label, const std::vector<double>& values, double margin = 0.05,
            AxisScale scale = AxisScale::linear);

}  // namespace turnpoint::plot
