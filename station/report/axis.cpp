#include "station/report/axis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "station/core/number.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

/// Two numbers whose relative difference is below this are treated as equal. Such a difference is a rounding
/// error, and dividing it into ticks would give an enormous number of them.
constexpr double kRounding = 1e-9;
/// With fewer labels than these, nobody can see that an axis is logarithmic.
constexpr std::size_t kFewestLogTicks = 3;

bool differ(double low, double high) {
  return high - low > kRounding * std::max(std::abs(low), std::abs(high));
}

void check(const Axis& axis) {
  const bool positive = axis.scale == AxisScale::linear || axis.low > 0;
  if (!differ(axis.low, axis.high) || !std::isfinite(axis.low) || !std::isfinite(axis.high) || !positive)
    throw std::invalid_argument(
        "axis \"" + axis.label + "\" from " + core::number(axis.low) + " to " + core::number(axis.high) +
        ": the limits must be finite and in ascending order, and above 0 on a log axis");
}

/// Formats a tick's value with a typographic minus sign.
std::string label(double value) { return with_minus(core::number(std::abs(value) < 1e-12 ? 0 : value, 6)); }

std::vector<Tick> linear_ticks(const Axis& axis, int wanted) {
  const double rough = (axis.high - axis.low) / std::max(wanted, 2);
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double round = rough / decade < 1.5   ? decade
                       : rough / decade < 3.5 ? 2 * decade
                       : rough / decade < 7.5 ? 5 * decade
                                              : 10 * decade;
  const double step = axis.counts ? std::max(1.0, round) : round;
  std::vector<Tick> result;
  const double slack = 1e-9 * (axis.high - axis.low);
  for (double n = std::ceil((axis.low - slack) / step); n * step <= axis.high + slack; ++n)
    result.push_back({n * step, label(n * step)});
  return result;
}

std::vector<Tick> named_ticks(const Axis& axis) {
  std::vector<Tick> result;
  for (std::size_t i = 0; i < axis.names.size(); ++i) {
    const auto place = static_cast<double>(i + 1);
    if (place >= axis.low && place <= axis.high) result.push_back({place, axis.names[i]});
  }
  return result;
}

/// Formats a power of ten with a raised exponent.
std::string power_of_ten(int exponent) {
  static const char* const raised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                       "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string result = exponent < 0 ? "10\u207b" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) result += raised[digit - '0'];
  return result;
}

/// The ticks of a log axis at these multiples of each decade.
std::vector<Tick> decade_ticks(const Axis& axis, const std::vector<double>& multiples, int wanted) {
  const int first = static_cast<int>(std::floor(std::log10(axis.low)));
  const int last = static_cast<int>(std::ceil(std::log10(axis.high)));
  const bool decades_only = multiples.size() == 1;
  const bool powers = decades_only && (first < -4 || last > 4);
  // Over many decades, each decade gets a tick, but only every second, third, ... tick gets a label.
  const int labelled = decades_only ? (last - first) / std::max(1, 2 * wanted) + 1 : 1;
  std::vector<Tick> result;
  for (int decade = first; decade <= last; ++decade)
    for (const double multiple : multiples) {
      const double value = multiple * std::pow(10.0, decade);
      if (value < axis.low * (1 - 1e-9) || value > axis.high * (1 + 1e-9)) continue;
      const bool quiet = decade % labelled != 0;
      result.push_back({value, quiet ? "" : powers ? power_of_ten(decade) : label(value)});
    }
  return result;
}

std::vector<Tick> log_ticks(const Axis& axis, int wanted) {
  static const std::vector<std::vector<double>> multiples{
      {1}, {1, 2, 5}, {1, 1.5, 2, 3, 5, 7}, {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9}};
  const bool many_decades =
      2 * (std::ceil(std::log10(axis.high)) - std::floor(std::log10(axis.low))) > wanted;
  for (std::size_t i = many_decades ? 0 : 1; i < multiples.size(); ++i) {
    auto result = decade_ticks(axis, multiples[i], wanted);
    const auto labels =
        std::count_if(result.begin(), result.end(), [](const Tick& tick) { return !tick.label.empty(); });
    if (labels >= static_cast<std::ptrdiff_t>(kFewestLogTicks)) return result;
  }
  for (int more = wanted;; ++more)
    if (auto result = linear_ticks(axis, more); result.size() >= kFewestLogTicks) return result;
}

}  // namespace

std::vector<Tick> ticks(const Axis& axis, int wanted) {
  check(axis);
  if (!axis.names.empty()) return named_ticks(axis);
  return axis.scale == AxisScale::linear ? linear_ticks(axis, wanted) : log_ticks(axis, wanted);
}

double position(const Axis& axis, double value) {
  if (axis.scale == AxisScale::linear) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

Axis fitted(std::string name, const std::vector<double>& values, double margin, AxisScale scale) {
  const bool logarithmic = scale == AxisScale::log10;
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
    const double on_axis = logarithmic ? std::log10(value) : value;
    low = std::min(low, on_axis);
    high = std::max(high, on_axis);
  }
  if (low > high) low = 0, high = 1;
  double room = margin * (high - low);
  if (!differ(low, high)) room = std::max(0.5 * std::abs(low), 0.5);
  low -= room;
  high += room;
  if (logarithmic) return {std::move(name), std::pow(10.0, low), std::pow(10.0, high), scale};
  return {std::move(name), low, high, scale};
}

}  // namespace turnpoint::report
