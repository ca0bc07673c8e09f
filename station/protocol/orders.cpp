#include "station/protocol/orders.hpp"

#include <algorithm>

#include "station/protocol/answers.hpp"

namespace turnpoint::protocol {

namespace {

std::vector<IntervalOrder> two_interval_orders(const Task& task) {
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

std::vector<IntervalOrder> same_different_orders(const Task& task) {
  const int same = answer_index(task, "same").value_or(-1),
            different = answer_index(task, "different").value_or(-1);
  const std::vector<std::string> a{task.standard}, b{task.target};
  return {{{a, a}, same}, {{b, b}, same}, {{a, b}, different}, {{b, a}, different}};
}

std::vector<IntervalOrder> oddity_orders(const Task& task) {
  std::vector<IntervalOrder> orders;
  const auto add = [&orders](const std::string& odd, const std::string& common) {
    for (int position = 0; position < 3; ++position) {
      IntervalOrder order{{{common}, {common}, {common}}, position};
      order.intervals[static_cast<std::size_t>(position)] = {odd};
      orders.push_back(std::move(order));
    }
  };
  if (task.odd != Odd::standard) add(task.target, task.standard);
  if (task.odd != Odd::target) add(task.standard, task.target);
  return orders;
}

std::vector<IntervalOrder> target_orders(const Task& task) {
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
std::vector<IntervalOrder> matching_orders(const Task& task) {
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

std::vector<IntervalOrder> orders_of(const Task& task) {
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
      if (!task.standard.empty() && !task.intervals.empty())
        return {{{{task.standard}, task.intervals.front()}, {}}};
      break;
    case TaskKind::comparison:
    case TaskKind::adjustment:
      break;
  }
  return {{task.intervals, {}}};
}

}  // namespace turnpoint::protocol
