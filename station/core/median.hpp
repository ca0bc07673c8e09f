#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace turnpoint::core {

/// The middle one of the values or, if their number is even, the mean of the middle two. There must be a
/// value.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace turnpoint::core
