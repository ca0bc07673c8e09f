#include "station/procedure/order.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "station/procedure/constant_stimuli.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;
using turnpoint::core::Draws;

namespace {

/// A list with `repeats` items of each value of one factor.
std::vector<OrderedItem> list_of(std::size_t values, std::size_t repeats, bool by_repeat = false) {
  std::vector<OrderedItem> items;
  for (std::size_t i = 0; i < values * repeats; ++i)
    items.push_back({{i % values}, by_repeat ? i / values : 0});
  return items;
}

Draws draws_of(std::uint64_t seed) { return Draws({seed, turnpoint::core::Stream::level_order, 0, 0, 0}); }

std::vector<std::size_t> values_of(const ListOrder& order, const std::vector<OrderedItem>& items,
                                   std::size_t factor = 0) {
  std::vector<std::size_t> values;
  for (const auto item : order.items) values.push_back(items[item].values[factor]);
  return values;
}

/// How often each sequence of this length comes.
std::map<std::vector<std::size_t>, int> sequences(const std::vector<std::size_t>& values,
                                                  std::size_t length) {
  std::map<std::vector<std::size_t>, int> counts;
  for (std::size_t i = 0; i + length <= values.size(); ++i)
    ++counts[{values.begin() + static_cast<std::ptrdiff_t>(i),
              values.begin() + static_cast<std::ptrdiff_t>(i + length)}];
  return counts;
}

bool all_kept(const std::vector<std::size_t>& values, const OrderRules& rules) {
  int length = 1;
  for (std::size_t i = 1; i < values.size(); ++i) {
    length = values[i] == values[i - 1] ? length + 1 : 1;
    for (const auto& run : rules.runs)
      if (length > run.limit) return false;
    for (const auto& never : rules.never)
      if (values[i - 1] == never.before && values[i] == never.now) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("each value comes equally often after each other one, or after each sequence of them",
          "[procedure]") {
  for (const auto& [values, back, times] : std::vector<std::array<std::size_t, 3>>{
           {2, 1, 1}, {5, 1, 1}, {5, 1, 4}, {3, 2, 1}, {4, 2, 2}, {2, 4, 3}, {3, 3, 1}}) {
    INFO(values << " values, " << back << " back, " << times << " times");
    std::size_t each = times;
    for (std::size_t i = 0; i < back; ++i) each *= values;
    const auto items = list_of(values, each);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      auto draws = draws_of(seed);
      const auto order = in_order(items, {{0}, back, {}, {}}, draws);
      REQUIRE(order.items.size() == items.size() + back);
      const auto found = sequences(values_of(order, items), back + 1);
      CHECK(found.size() == each / times * values);
      for (const auto& [sequence, count] : found) CHECK(count == static_cast<int>(times));
      // each item comes, and those at the start once more
      CHECK(std::set(order.items.begin() + static_cast<std::ptrdiff_t>(back), order.items.end()).size() ==
            items.size());
    }
  }
}

TEST_CASE("a value that never follows itself follows each other one equally often", "[procedure]") {
  const auto items = list_of(4, 6);
  OrderRules rules{{0}, 1, {}, {{0, 1}}};
  auto draws = draws_of(1);
  const auto found = sequences(values_of(in_order(items, rules, draws), items), 2);
  CHECK(found.size() == 12);
  for (const auto& [pair, count] : found) {
    CHECK(pair[0] != pair[1]);
    CHECK(count == 2);
  }
  rules.back = 2;  // each after each pair of the others
  const auto triples = sequences(values_of(in_order(list_of(4, 9), rules, draws), list_of(4, 9)), 3);
  CHECK(triples.size() == 36);
  rules = {{0}, 1, {}, {{0, 2}}};  // runs of two are allowed, and each pair comes
  const auto list = list_of(5, 10);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    draws = draws_of(seed);
    const auto order = in_order(list, rules, draws);
    REQUIRE(order.problem.empty());
    CHECK(all_kept(values_of(order, list), rules));
  }
}

TEST_CASE("combinations of two factors follow each other equally often", "[procedure]") {
  std::vector<OrderedItem> items;
  for (std::size_t i = 0; i < 2 * 3 * 12; ++i) items.push_back({{i % 3, i / 3 % 2}, 0});
  auto draws = draws_of(3);
  const auto order = in_order(items, {{0, 1}, 1, {}, {}}, draws);
  const auto levels = values_of(order, items, 0), sides = values_of(order, items, 1);
  std::vector<std::size_t> both;
  for (std::size_t i = 0; i < levels.size(); ++i) both.push_back(10 * levels[i] + sides[i]);
  const auto found = sequences(both, 2);
  CHECK(found.size() == 36);
  for (const auto& [pair, count] : found) CHECK(count == 2);
  // Only one of two factors has the rule: the other one is drawn.
  const auto one = sequences(values_of(in_order(items, {{1}, 1, {}, {}}, draws), items, 1), 2);
  CHECK(one.size() == 4);
  for (const auto& [pair, count] : one) CHECK(count == 18);
}

TEST_CASE("all orders of a list in which each value follows each one are equally likely", "[procedure]") {
  // A graph of three nodes with 9 edges, loops included, has 3 trees and so 3 x (2!)^3 circuits (de Bruijn &
  // van Aardenne-Ehrenfest). With 9 places to begin, that is 216 lists.
  const auto items = list_of(3, 3);
  std::map<std::vector<std::size_t>, int> counts;
  constexpr int sets = 21'600;
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    auto draws = draws_of(seed);
    ++counts[values_of(in_order(items, {{0}, 1, {}, {}}, draws), items)];
  }
  CHECK(counts.size() == 216);
  double chi = 0;
  for (const auto& [list, count] : counts) chi += (count - 100.0) * (count - 100.0) / 100;
  CHECK(chi < 290);  // 215 degrees of freedom: more in 1 of 2000 runs
}

TEST_CASE("rules that only forbid are kept if any order keeps them, and refused otherwise", "[procedure]") {
  auto random = draws_of(99);
  int possible = 0, impossible = 0;
  for (int set = 0; set < 300; ++set) {
    const auto items = list_of(2 + random.below(3), 2, set % 3 == 0);
    const auto values = items.back().values[0] + 1;
    OrderRules rules;
    for (std::size_t a = 0; a < values; ++a)
      for (std::size_t b = 0; b < values; ++b)
        if (random.uniform() < 0.35) rules.never.push_back({0, a, b});
    if (set % 2) rules.runs.push_back({0, 1 + static_cast<int>(random.below(2))});
    if (rules.never.empty()) continue;
    // the truth, by looking at all orders
    std::vector<std::size_t> order(items.size());
    std::iota(order.begin(), order.end(), 0);
    bool exists = false;
    do {
      std::vector<std::size_t> list;
      bool by_repeat = true;
      for (std::size_t i = 0; i < order.size(); ++i) {
        list.push_back(items[order[i]].values[0]);
        by_repeat = by_repeat && (i == 0 || items[order[i]].repeat >= items[order[i - 1]].repeat);
      }
      exists = exists || (by_repeat && all_kept(list, rules));
    } while (!exists && std::next_permutation(order.begin(), order.end()));
    auto draws = draws_of(static_cast<std::uint64_t>(set));
    const auto found = in_order(items, rules, draws);
    CHECK(found.problem.empty() == exists);
    (exists ? possible : impossible) += 1;
    if (!exists) continue;
    CHECK(all_kept(values_of(found, items), rules));
    CHECK(std::set(found.items.begin(), found.items.end()).size() == items.size());
    for (std::size_t i = 1; i < found.items.size(); ++i)
      CHECK(items[found.items[i]].repeat >= items[found.items[i - 1]].repeat);
  }
  CHECK(possible > 50);
  CHECK(impossible > 50);
}

TEST_CASE("a long list with forbidden pairs and short runs is ordered for every seed", "[procedure]") {
  std::vector<OrderedItem> items;  // two factors: 7 levels x 2 sides x 20
  for (std::size_t i = 0; i < 280; ++i) items.push_back({{i % 7, i / 7 % 2}, 0});
  const OrderRules rules{{}, 1, {{0, 0, 6}, {0, 6, 0}, {1, 1, 1}}, {{0, 1}, {1, 3}}};
  std::set<std::vector<std::size_t>> different;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    auto draws = draws_of(seed);
    const auto order = in_order(items, rules, draws);
    REQUIRE(order.problem.empty());
    different.insert(order.items);
    const auto levels = values_of(order, items, 0), sides = values_of(order, items, 1);
    CHECK(all_kept(levels, {{}, 1, {{0, 0, 6}, {0, 6, 0}}, {{0, 1}}}));
    CHECK(all_kept(sides, {{}, 1, {{1, 1, 1}}, {{1, 3}}}));
  }
  CHECK(different.size() == 50);
}

TEST_CASE("a list with rules keeps its order when trials are not answered", "[procedure]") {
  Spec spec;
  spec.name = "levels", spec.level = "offset_mm";
  spec.values = {-3, -1, 1, 3}, spec.repeats = 8;
  spec.rules = {{0}, 1, {}, {}};
  CHECK_FALSE(order_problem(spec, {}));
  const auto answered = [&spec](int every) {
    const auto procedure = make_procedure(spec, {}, {5, {}, 1, 0, 0});
    CHECK(procedure->expected() == 33);
    std::vector<double> levels;
    for (int i = 1; procedure->next() && i < 1000; ++i) {
      CHECK(procedure->candidates().size() == 1);
      const auto level = procedure->next()->level;
      if (i % every == 0) {
        procedure->record(Answer::none);
        CHECK(procedure->next()->level == level);
      } else {
        procedure->record(Answer::one), levels.push_back(level);
      }
    }
    return levels;
  };
  const auto whole = answered(1'000'000);
  CHECK(whole.size() == 33);
  CHECK(answered(4) == whole);
  spec.repeats = 6;
  const auto problem = order_problem(spec, {});
  REQUIRE(problem);
  CHECK(turnpoint::core::say(problem->what, "en") ==
        "each value comes 6 times in the list, and may follow 4 others");
  CHECK_THROWS_AS(make_procedure(spec, {}, {5, {}, 1, 0, 0}), NoOrder);
}

TEST_CASE("a list that was accepted has an order in every session, whatever its draws", "[procedure]") {
  auto random = draws_of(7);
  int accepted = 0;
  for (int set = 0; set < 60; ++set) {
    Spec spec;
    spec.name = "levels", spec.level = "offset_mm", spec.shuffle = Shuffle::within_block;
    for (int i = 0; i < 9; ++i) spec.values.push_back(i);
    spec.repeats = 2 + set % 2, spec.balance = {"side", "mark"};
    const Context context{{{"side", 2}, {"mark", 3}}};
    for (std::size_t a = 0; a < 9; ++a)  // an order exists, if only few: each value after the one before it
      for (std::size_t b = 0; b < 9; ++b)
        if (b != (a + 1) % 9 && random.uniform() < 0.8) spec.rules.never.push_back({0, a, b});
    if (order_problem(spec, context)) continue;
    ++accepted;
    for (std::uint64_t seed = 0; seed < 20; ++seed)
      CHECK_NOTHROW(make_procedure(spec, context, {seed, {}, 1, 0, 0}));
  }
  CHECK(accepted > 50);
}

TEST_CASE("a long list is ordered in a bounded time, or refused as too long for its rules", "[procedure]") {
  const OrderRules pair{{}, 1, {{0, 3, 5}}, {}};
  auto items = list_of(1000, 3);
  for (std::size_t i = 0; i < items.size(); ++i) items[i].values.push_back(i % 7);  // a factor without rules
  auto draws = draws_of(1);
  const auto order = in_order(items, pair, draws);
  REQUIRE(order.problem.empty());
  CHECK(all_kept(values_of(order, items), pair));
  CHECK(in_order(list_of(4, 25'000), pair, draws).problem.empty());
  // A run of one tells all values apart.
  const OrderRules run{{}, 1, {{0, 3, 5}}, {{0, 1}}};
  CHECK(in_order(list_of(100, 5), run, draws).problem.empty());
  const auto refused = in_order(list_of(1000, 3), run, draws);
  CHECK(turnpoint::core::say(refused.problem, "en") ==
        "the list is too long for rules of its order: 3000 trials, of 1000 kinds that the rules tell apart");
  CHECK(turnpoint::core::say(refused.allowed, "en") ==
        "fewer trials, or at most 129 such kinds in as many trials");
}
