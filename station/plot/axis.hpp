#pragma once
#include <string>
#include <vector>

namespace turnpoint::plot {

enum class AxisScale { linear, log10 };

/// What one side of a panel shows.
struct Axis {
  std::string label;  ///< with the unit: "Friction contrast (dB)"
  double low = 0, high = 1;
  AxisScale scale = AxisScale::linear;
};

struct Tick {
  double value = 0;
  std::string label;
};

/// About `wanted` ticks inside the axis at 1, 2 or 5 times a power of ten, with as many decimals as the step
/// needs. log10: 1, 2, 5 of each decade, or decades alone where there are many, then as powers of ten, some
/// without a label. Throws std::invalid_argument
/// where low < high does not hold, a limit is not finite, or a log10 axis is not positive.
std::vector<Tick> ticks(const Axis& axis, int wanted = 6);

/// 0 at the low end, 1 at the high end.
double position(const Axis& axis, double value);

/// Limits that hold all finite values (positive ones for log10) with a margin of `margin` of their range. One
/// value, or none, gets room around it.
Axis fitted(std::string label, const std::vector<double>& values, double margin = 0.05,
            AxisScale scale = AxisScale::linear);

}  // namespace turnpoint::plot
