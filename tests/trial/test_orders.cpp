#include <map>

#include "station/trial/orders.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::trial;

namespace {

protocol::Task task_of(protocol::TaskKind kind) {
  protocol::Task task;
  task.kind = kind;
  task.intervals = {{"reference"}, {"comparison"}};
  task.correct_scene = "comparison";
  task.standard = "standard";
  task.target = "wider";
  task.choices = {{"same", {}}, {"different", {}}};
  return task;
}

}  // namespace

TEST_CASE("two intervals come in both orders equally often, and the right answer follows the scene",
          "[session]") {
  const auto task = task_of(protocol::TaskKind::two_interval);
  int first = 0;
  for (int trial = 0; trial < 48; ++trial) {
    const auto order = order_for(orders_of(task), 9, 1, 0, trial);
    REQUIRE(order.correct.has_value());
    CHECK(order.intervals[static_cast<std::size_t>(*order.correct)].front() == "comparison");
    first += *order.correct == 0 ? 1 : 0;
  }
  CHECK(first == 24);
}

TEST_CASE("oddity presents three intervals of which the right one differs, in all six ways", "[session]") {
  const auto task = task_of(protocol::TaskKind::oddity);
  std::map<std::vector<std::vector<std::string>>, int> counts;
  for (int trial = 0; trial < 36; ++trial) {
    const auto order = order_for(orders_of(task), 9, 1, 0, trial);
    const auto odd = static_cast<std::size_t>(*order.correct);
    CHECK(order.intervals[odd] != order.intervals[(odd + 1) % 3]);
    CHECK(order.intervals[(odd + 1) % 3] == order.intervals[(odd + 2) % 3]);
    ++counts[order.intervals];
  }
  CHECK(counts.size() == 6);
  for (const auto& [intervals, count] : counts) CHECK(count == 6);
}

TEST_CASE("same-different is balanced over its four pairs", "[session]") {
  const auto task = task_of(protocol::TaskKind::same_different);
  int different = 0;
  for (int trial = 0; trial < 24; ++trial) different += *order_for(orders_of(task), 1, 0, 0, trial).correct;
  CHECK(different == 12);
}

TEST_CASE("of three or four intervals the target is in each equally often", "[session]") {
  for (const std::size_t m : {3, 4}) {
    auto task = task_of(protocol::TaskKind::several_intervals);
    task.choices.assign(m, {"x", {}});
    std::map<int, int> counts;
    for (int trial = 0; trial < 48; ++trial) {
      const auto order = order_for(orders_of(task), 9, 1, 0, trial);
      REQUIRE(order.intervals.size() == m);
      for (std::size_t i = 0; i < m; ++i)
        CHECK(order.intervals[i].front() == (static_cast<int>(i) == *order.correct ? "wider" : "standard"));
      ++counts[*order.correct];
    }
    CHECK(counts.size() == m);
    for (const auto& [position, count] : counts) CHECK(count == 48 / static_cast<int>(m));
  }
}

TEST_CASE("X is one of A and B, in all four orders, and comes last in ABX and first in match-to-sample",
          "[session]") {
  for (const auto kind : {protocol::TaskKind::abx, protocol::TaskKind::match_to_sample}) {
    const bool first = kind == protocol::TaskKind::match_to_sample;
    std::map<std::vector<std::vector<std::string>>, int> counts;
    for (int trial = 0; trial < 24; ++trial) {
      const auto order = order_for(orders_of(task_of(kind)), 9, 1, 0, trial);
      REQUIRE(order.intervals.size() == 3);
      const auto& x = order.intervals[first ? 0 : 2];
      const auto right = static_cast<std::size_t>(*order.correct);
      CHECK(order.intervals[right + (first ? 1 : 0)] == x);
      CHECK(order.intervals[1 - right + (first ? 1 : 0)] != x);
      ++counts[order.intervals];
    }
    CHECK(counts.size() == 4);
    for (const auto& [intervals, count] : counts) CHECK(count == 6);
  }
}
