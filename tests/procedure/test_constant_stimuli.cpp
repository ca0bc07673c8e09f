#include <map>
#include <string>
#include <vector>

#include "station/procedure/constant_stimuli.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

Spec offsets() {
  Spec spec;
  spec.name = "levels";
  spec.level = "offset_mm";
  spec.values = {-30, -18, -9, -3, 3, 9, 18, 30};
  spec.repeats = 10;
  spec.balance = {"mark_mm"};
  return spec;
}

Context marks() {
  Context context;
  context.factor_levels = {{"mark_mm", 3}};
  return context;
}

}  // namespace

TEST_CASE("constant stimuli present each value equally often, balanced", "[procedure]") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto procedure = make_procedure(offsets(), marks(), {seed, {}, 1, 0, 0});
    std::map<double, int> counts;
    std::map<std::pair<double, std::size_t>, int> crossed;
    while (const auto proposal = procedure->next()) {
      ++counts[proposal->level];
      ++crossed[{proposal->level, proposal->balanced.at(0).second}];
      procedure->record(Answer::one);
    }
    CHECK(procedure->recorded() == 80);
    for (const auto& [level, count] : counts) CHECK(count == 10);
    for (const auto& [pair, count] : crossed) CHECK((count == 3 || count == 4));
  }
}

TEST_CASE("several balanced factors are crossed as evenly as the repeats allow", "[procedure]") {
  auto spec = offsets();
  spec.balance = {"mark_mm", "speed", "hand"};
  auto context = marks();
  context.factor_levels = {{"mark_mm", 3}, {"speed", 2}, {"hand", 2}};
  spec.repeats = GENERATE(1, 4, 7, 12, 20, 24);
  spec.shuffle = GENERATE(Shuffle::within_repeat, Shuffle::within_block);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto procedure = make_procedure(spec, context, {seed, {}, 1, 0, 0});
    std::map<double, std::map<std::vector<std::size_t>, int>> met;
    for (; procedure->next(); procedure->record(Answer::one)) {
      const auto proposal = *procedure->next();
      const auto mark = proposal.balanced[0].second, speed = proposal.balanced[1].second,
                 hand = proposal.balanced[2].second;
      auto& counts = met[proposal.level];
      ++counts[{0, mark}], ++counts[{1, speed}], ++counts[{2, hand}], ++counts[{3, mark, speed, hand}];
    }
    for (auto& [level, counts] : met) {
      const auto even = [&](std::vector<std::size_t> cell, int cells) {
        const int times = counts[cell], least = spec.repeats / cells;
        return times == least || (times == least + 1 && spec.repeats % cells != 0);
      };
      for (std::size_t mark = 0; mark < 3; ++mark) {
        CHECK(even({0, mark}, 3));
        for (std::size_t speed = 0; speed < 2; ++speed)
          for (std::size_t hand = 0; hand < 2; ++hand) CHECK(even({3, mark, speed, hand}, 12));
      }
      for (std::size_t either = 0; either < 2; ++either)
        CHECK((even({1, either}, 2) && even({2, either}, 2)));
    }
  }
}

TEST_CASE("a single balanced factor gets the same levels as in earlier releases", "[procedure]") {
  auto spec = offsets();
  spec.values = {-9, 9};
  spec.repeats = 7;
  std::string levels;
  const auto procedure = make_procedure(spec, marks(), {3, {}, 1, 0, 0});
  for (; procedure->next(); procedure->record(Answer::one))
    levels += std::to_string(procedure->next()->balanced.at(0).second);
  CHECK(levels == "01201201220110");
}

TEST_CASE("an unanswered trial is repeated later, unless its deadline is part of the design", "[procedure]") {
  auto context = marks();
  context.unanswered_are_data = GENERATE(false, true);
  const auto procedure = make_procedure(offsets(), context, {7, {}, 0, 0, 0});
  procedure->record(Answer::none);
  int shown = 1;
  for (; procedure->next(); ++shown) procedure->record(Answer::zero);
  CHECK(shown == (context.unanswered_are_data ? 80 : 81));
  CHECK(procedure->recorded() == 80);
}

TEST_CASE("the same key gives the same order, and another attempt gives another order", "[procedure]") {
  const auto order = [](int attempt) {
    std::vector<double> levels;
    const auto procedure = make_procedure(offsets(), marks(), {7, {}, 0, attempt, 0});
    for (; procedure->next(); procedure->record(Answer::one)) levels.push_back(procedure->next()->level);
    return levels;
  };
  CHECK(order(0) == order(0));
  CHECK(order(0) != order(1));
}

TEST_CASE("adjustment starts from every level equally often, and repeats trials without a setting",
          "[procedure]") {
  Spec spec;
  spec.name = "settings";
  spec.level = "offset_mm";
  spec.kind = Kind::adjustment;
  CHECK(validate(spec).size() == 1);  // the start levels are missing
  spec.values = {-20, 20};
  spec.repeats = 3;
  const auto procedure = make_procedure(spec, {}, {});
  CHECK(procedure->expected() == 6);
  procedure->record(Answer::none);
  double sum = 0;
  int trials = 0;
  for (; const auto proposal = procedure->next(); ++trials) {
    sum += proposal->level;
    procedure->record(Answer::one);
  }
  CHECK(trials == 6);
  CHECK(sum == 0);
}
