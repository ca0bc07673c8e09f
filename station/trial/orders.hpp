#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/core/draws.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::trial {

/// The intervals of one trial in the order of presentation, and the index of the right choice.
struct IntervalOrder {
  std::vector<std::vector<std::string>> intervals;
  std::optional<int> correct;
};

/// Returns all orders of intervals that a task can have: 2 for two intervals, 3 or 4 for 3ifc and 4ifc, 4 for
/// same-different, ABX and match-to-sample, 3 or 6 for oddity, otherwise 1. `correct` is empty if the right
/// choice depends on the factors (tasks with one interval).
std::vector<IntervalOrder> orders_of(const protocol::Task& task);

/// Returns the order for a trial, one of orders_of(). Trials are divided into runs of equal length, and each
/// run contains every order equally often. Each run is shuffled with random numbers whose key contains the
/// run's number, so the order of trial k can be computed without computing the other runs.
const IntervalOrder& order_for(const std::vector<IntervalOrder>& orders, std::uint64_t seed, int block,
                               int attempt, int trial);

/// Returns the number of trials in a run of order_for().
int run_of_orders();

/// The levels of a friction table in the order to present them: each level `repeats` times, in random order,
/// with the surface at rest (0) before, between and after them.
std::vector<double> friction_table_order(std::span<const double> levels, int repeats,
                                         const core::DrawKey& key);

/// Returns the right choice for these factors; empty if none of the task's comparisons is true. If the
/// comparisons are about scenes (2ifc), it is the place of the right scene in `intervals`.
std::optional<int> correct_choice(const protocol::Task& task, const protocol::Factors& factors,
                                  const std::vector<std::vector<std::string>>& intervals);

}  // namespace turnpoint::trial
