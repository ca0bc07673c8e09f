#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// The intervals of one trial in the order of presentation, and the index of the right choice.
struct IntervalOrder {
  std::vector<std::vector<std::string>> intervals;
  std::optional<int> correct;
};

/// Returns all orders of intervals that a task can have: 2 for two intervals, 3 or 4 for 3ifc and 4ifc, 4 for
/// same-different, ABX and match-to-sample, 3 or 6 for oddity, otherwise 1. `correct` is empty if the right
/// choice depends on the factors (tasks with one interval).
std::vector<IntervalOrder> orders_of(const Task& task);

}  // namespace turnpoint::protocol
