#include <map>

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
  spec.max_run = 4;
  return spec;
}

Context marks() {
  Context context;
  context.factor_levels = {{"mark_mm", 3}};
  context.right_answer = [](double level) { return level < 0 ? 0 : 1; };
  return context;
}

}  // namespace

TEST_CASE("constant stimuli present each value as often, balanced, without long runs", "[procedure]") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto procedure = make_procedure(offsets(), marks(), {seed, {}, 1, 0, 0});
    std::map<double, int> counts;
    std::map<std::pair<double, std::size_t>, int> crossed;
    int run = 0, last = -1;
    while (const auto proposal = procedure->next()) {
      ++counts[proposal->level];
      ++crossed[{proposal->level, proposal->balanced.at(0).second}];
      const int right = proposal->level < 0 ? 0 : 1;
      run = right == last ? run + 1 : 1;
      last = right;
      if (run > 4) FAIL("five equal right answers in a row at seed " << seed);
      procedure->record(Answer::one);
    }
    CHECK(procedure->recorded() == 80);
    for (const auto& [level, count] : counts) CHECK(count == 10);
    for (const auto& [pair, count] : crossed) CHECK((count == 3 || count == 4));
  }
}

TEST_CASE("an unanswered trial comes again later, unless its deadline is part of the design", "[procedure]") {
  auto context = marks();
  context.unanswered_are_data = GENERATE(false, true);
  const auto procedure = make_procedure(offsets(), context, {7, {}, 0, 0, 0});
  procedure->record(Answer::none);
  int shown = 1;
  for (; procedure->next(); ++shown) procedure->record(Answer::zero);
  CHECK(shown == (context.unanswered_are_data ? 80 : 81));
  CHECK(procedure->recorded() == 80);
}

TEST_CASE("the same key gives the same order, another attempt another", "[procedure]") {
  const auto order = [](int attempt) {
    std::vector<double> levels;
    const auto procedure = make_procedure(offsets(), marks(), {7, {}, 0, attempt, 0});
    for (; procedure->next(); procedure->record(Answer::one)) levels.push_back(procedure->next()->level);
    return levels;
  };
  CHECK(order(0) == order(0));
  CHECK(order(0) != order(1));
}

TEST_CASE("adjustment starts from every level equally often, and again where nothing was set",
          "[procedure]") {
  Spec spec;
  spec.name = "settings";
  spec.level = "offset_mm";
  spec.kind = Kind::adjustment;
  CHECK(validate(spec).size() == 1);  // no level to start from
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
