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

std::vector<IntervalOrder> two_interval_orders(const protocol::Task& task) {
  std::vector<IntervalOrder> orders;
  for (const bool swapped : {false, true}) {
    IntervalOrder order{task.intervals, {}};
    if (swapped) std::reverse(order.intervals.begin(), order.intervals.end());
    for (std::size_t i = 0; i < order.intervals.size(); ++i)
      if (std::find(order.intervals[i].begin(), order.intervals[i].end(), task.correct_scene) !=
          order.intervals[i].end())
        order.correct = static_cast<int>(i);
    orders.push_back(std::move(order));
  }
  return orders;
}

std::vector<IntervalOrder> same_different_orders(const protocol::Task& task) {
  const int same = choice_index(task, "same"), different = choice_index(task, "different");
  const std::vector<std::string> a{task.standard}, b{task.target};
  return {{{a, a}, same}, {{b, b}, same}, {{a, b}, different}, {{b, a}, different}};
}

std::vector<IntervalOrder> oddity_orders(const protocol::Task& task) {
  std::vector<IntervalOrder> orders;
  const auto add = [&orders](const std::string& odd, const std::string& common) {
    for (int position = 0; position < 3; ++position) {
      IntervalOrder order{{{common}, {common}, {common}}, position};
      order.intervals[static_cast<std::size_t>(position)] = {odd};
      orders.push_back(std::move(order));
    }
  };
  if (task.odd != protocol::Odd::standard) add(task.target, task.standard);
  if (task.odd != protocol::Odd::target) add(task.standard, task.target);
  return orders;
}

std::vector<IntervalOrder> target_orders(const protocol::Task& task) {
  std::vector<IntervalOrder> orders;
  for (std::size_t position = 0; position < task.choices.size(); ++position) {
    IntervalOrder order{{task.choices.size(), {task.standard}}, static_cast<int>(position)};
    order.intervals[position] = {task.target};
    orders.push_back(std::move(order));
  }
  return orders;
}

// All orders of a trial with two scenes A and B and a third one, X, that repeats one of them: A and B in
// either order, and X first or last.
std::vector<IntervalOrder> matching_orders(const protocol::Task& task) {
  std::vector<IntervalOrder> orders;
  for (const bool swapped : {false, true})
    for (const int same : {0, 1}) {
      IntervalOrder order{{{task.standard}, {task.target}}, same};
      if (swapped) std::reverse(order.intervals.begin(), order.intervals.end());
      const auto x = order.intervals[static_cast<std::size_t>(same)];
      order.intervals.insert(task.kind == TaskKind::abx ? order.intervals.end() : order.intervals.begin(), x);
      orders.push_back(std::move(order));
    }
  return orders;
}

}  // namespace

std::vector<IntervalOrder> orders_of(const protocol::Task& task) {
  switch (task.kind) {
    case TaskKind::two_interval:
      return two_interval_orders(task);
    case TaskKind::same_different:
      return same_different_orders(task);
    case TaskKind::several_intervals:
      return target_orders(task);
    case TaskKind::oddity:
      return oddity_orders(task);
    case TaskKind::abx:
    case TaskKind::match_to_sample:
      return matching_orders(task);
    case TaskKind::single_interval:
      if (!task.standard.empty()) return {{{{task.standard}, task.intervals.front()}, {}}};
      break;
    case TaskKind::comparison:
    case TaskKind::adjustment:
      break;
  }
  return {{task.intervals, {}}};
}

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
