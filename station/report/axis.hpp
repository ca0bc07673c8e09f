#pragma once
#include <limits>
#include <string>
#include <vector>

namespace turnpoint::report {

enum class AxisScale { linear, log10 };

/// What one axis of a chart shows.
struct Axis {
  std::string label;  ///< quantity and unit: "Friction contrast (dB)"
  double low = 0, high = 1;
  AxisScale scale = AxisScale::linear;
  bool counts = false;  ///< true if only whole numbers get a tick; for a linear axis
  /// Names of the places 1, 2, 3, ... of the axis, such as participants' codes. They are its only ticks.
  std::vector<std::string> names = {};

  /// No value can be above this, such as 1 for a proportion; a marker that is drawn beside another stays
  /// below.
  double most = std::numeric_limits<double>::infinity();

  bool operator==(const Axis&) const = default;
};

struct Tick {
  double value = 0;
  std::string label;
};

/// Returns about `wanted` ticks.
/// - Linear axis: ticks at multiples of 1, 2 or 5 times a power of ten, with as many decimals as the step
///   needs.
/// - log10 axis: ticks at 1, 2 and 5 of each decade. Over many decades, only the decades have ticks, labelled
///   as powers of ten; some labels may be missing. At least three ticks have labels: a narrow axis has more
///   of them in each decade, and a very narrow one those of a linear axis.
/// Throws std::invalid_argument unless low < high, both limits are finite, and both are positive on a log10
/// axis.
std::vector<Tick> ticks(const Axis& axis, int wanted = 6);

/// Returns the position of a value along the axis: 0 at the low end, 1 at the high end.
double position(const Axis& axis, double value);

/// Returns an axis whose limits include all finite values (for log10: all positive values), with a margin of
/// `margin` times their range. If all values are equal, or if there are none, the limits still differ.
Axis fitted(std::string label, const std::vector<double>& values, double margin = 0.05,
            AxisScale scale = AxisScale::linear);

}  // namespace turnpoint::report
