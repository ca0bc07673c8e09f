#include "station/trial/orders.hpp"

#include <algorithm>

#include "station/core/draws.hpp"

namespace turnpoint::trial {

namespace {

using protocol::TaskKind;

// number of trials in a run (see order_for()); divisible by every possible number of orders
constexpr int kRun = 12;

int choice_index(const protocol::Task& task, const std::string& id) {
  for (std::size_t i = 0; i < task.choices.size(); ++i)
    if (task.choices[i].id == id) return static_cast<int>(i);
  return -1;
}

}  // namespace

int run_of_orders() { return kRun; }

const IntervalOrder& order_for(const std::vector<IntervalOrder>& orders, std::uint64_t seed, int block,
                               int attempt, int trial) {
  if (orders.size() == 1) return orders.front();
  std::vector<std::size_t> run;
  for (int i = 0; i < kRun; ++i) run.push_back(static_cast<std::size_t>(i) % orders.size());
  core::Draws draws({seed, core::Stream::interval_order, block, attempt, trial / kRun});
  draws.shuffle(run);
  return orders[run[static_cast<std::size_t>(trial % kRun)]];
}

std::vector<double> friction_table_order(std::span<const double> levels, int repeats,
                                         const core::DrawKey& key) {
  std::vector<double> driven;
  for (int i = 0; i < repeats; ++i) driven.insert(driven.end(), levels.begin(), levels.end());
  core::Draws(key).shuffle(driven);
  std::vector<double> order{0};
  for (const double level : driven) {
    order.push_back(level);
    order.push_back(0);
  }
  return order;
}

std::optional<int> correct_choice(const protocol::Task& task, const protocol::Factors& factors,
                                  const std::vector<std::vector<std::string>>& intervals) {
  for (const auto& [id, comparison] : task.correct_answer)
    if (protocol::holds(comparison, factors)) {
      if (task.kind != TaskKind::two_interval) return choice_index(task, id);
      for (std::size_t i = 0; i < intervals.size(); ++i)
        if (std::find(intervals[i].begin(), intervals[i].end(), id) != intervals[i].end())
          return static_cast<int>(i);
    }
  return std::nullopt;
}

}  // namespace turnpoint::trial
