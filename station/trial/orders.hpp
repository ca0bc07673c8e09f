#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/core/draws.hpp"
#include "station/protocol/orders.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::trial {

using protocol::IntervalOrder, protocol::orders_of;

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
