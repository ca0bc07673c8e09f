#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::trial {

/// The intervals of one trial as they are presented, and which choice is right.
struct IntervalOrder {
  std::vector<std::vector<std::string>> intervals;
  std::optional<int> correct;
};

/// All orders that a task can have: 2 for two intervals, 2 or 4 for same-different, 3 or 6 for oddity, 1
/// otherwise. `correct` is left open where it depends on the factors (single-interval comparisons).
std::vector<IntervalOrder> orders_of(const protocol::Task& task);

/// The order for a trial: every run of as many trials as a multiple of the number of orders holds each
/// equally often, shuffled by draws keyed on the run, so that trial k can be asked for alone.
IntervalOrder order_for(const protocol::Task& task, std::uint64_t seed, int block, int attempt, int trial);

/// The right choice of a single-interval task for these factors; none where no comparison holds.
std::optional<int> correct_choice(const protocol::Task& task, const protocol::Factors& factors);

}  // namespace turnpoint::trial
