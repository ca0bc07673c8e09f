#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "station/procedure/procedure.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::procedure;

namespace {

Spec compared(std::size_t together, std::vector<double> values, int repeats) {
  Spec spec;
  spec.name = "comparisons";
  spec.kind = Kind::comparisons;
  spec.level = "a";
  const std::vector<std::string> others{"b", "c", "d"};
  spec.against.assign(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(together - 1));
  spec.values = std::move(values);
  spec.repeats = repeats;
  return spec;
}

using Stimuli = std::vector<double>;

Stimuli stimuli_of(const Proposal& proposal) {
  Stimuli all{proposal.level};
  all.insert(all.end(), proposal.against.begin(), proposal.against.end());
  return all;
}

std::vector<Stimuli> presented(const Spec& spec, std::uint64_t seed = 1) {
  const auto procedure = make_procedure(spec, {}, key_of(seed, 0, 0, 0));
  CHECK(procedure->expected() == static_cast<int>(list_trials(spec)));
  std::vector<Stimuli> all;
  while (const auto proposal = procedure->next()) {
    all.push_back(stimuli_of(*proposal));
    procedure->record(Answer::zero);
  }
  CHECK(procedure->recorded() == procedure->expected());
  return all;
}

}  // namespace

TEST_CASE("each repeat of all pairs has every pair in both orders", "[procedure][comparisons]") {
  const auto all = presented(compared(2, {3, 1, 4, 2}, 3));
  REQUIRE(all.size() == 3 * 12);
  for (std::size_t repeat = 0; repeat < 3; ++repeat) {
    const std::set<Stimuli> once(all.begin() + static_cast<std::ptrdiff_t>(12 * repeat),
                                 all.begin() + static_cast<std::ptrdiff_t>(12 * repeat + 12));
    CHECK(once.size() == 12);
    for (const auto& pair : once) CHECK(pair[0] != pair[1]);
  }
  CHECK(presented(compared(2, {3, 1, 4, 2}, 3)) == all);  // the same seed gives the same order
  CHECK(presented(compared(2, {3, 1, 4, 2}, 3), 2) != all);
}

TEST_CASE("triads come forth and back equally often, with the middle stimulus in the middle",
          "[procedure][comparisons]") {
  const auto all = presented(compared(3, {1, 2, 3, 4, 5}, 2));
  REQUIRE(all.size() == 2 * 10);
  CHECK(std::set<Stimuli>(all.begin(), all.end()).size() == 20);
  int forth = 0;
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK((all[i][0] < all[i][1]) == (all[i][1] < all[i][2]));
    forth += all[i][0] < all[i][1] ? 1 : 0;
  }
  CHECK(forth == 5);
}

TEST_CASE("the order in which the values are listed does not matter", "[procedure][comparisons]") {
  for (const std::size_t together : {2, 3, 4})
    CHECK(presented(compared(together, {4, 1, 6, 3, 2, 5}, 2)) ==
          presented(compared(together, {1, 2, 3, 4, 5, 6}, 2)));
}

TEST_CASE("quadruples have two pairs that do not overlap, in four forms", "[procedure][comparisons]") {
  const auto all = presented(compared(4, {1, 2, 3, 4, 5, 6}, 4));
  REQUIRE(all.size() == 4 * 15);
  CHECK(std::set<Stimuli>(all.begin(), all.end()).size() == 60);
  for (const auto& s : all)
    CHECK((std::max(s[0], s[1]) < std::min(s[2], s[3]) || std::max(s[2], s[3]) < std::min(s[0], s[1])));
}

TEST_CASE("an unanswered comparison comes again later", "[procedure][comparisons]") {
  const auto procedure = make_procedure(compared(2, {1, 2, 3}, 1), {}, key_of(1, 0, 0, 0));
  const auto missed = stimuli_of(*procedure->next());
  procedure->record(Answer::none);
  CHECK(procedure->recorded() == 0);
  std::map<Stimuli, int> times;
  while (const auto proposal = procedure->next())
    ++times[stimuli_of(*proposal)], procedure->record(Answer::one);
  CHECK(times.size() == 6);
  CHECK(times[missed] == 1);
}

TEST_CASE("comparisons need enough different stimuli, and not too many", "[procedure][comparisons]") {
  const auto key = [](const Spec& spec) {
    const auto problems = validate(spec);
    return problems.empty() ? "" : problems.front().key;
  };
  CHECK(key(compared(2, {1, 2}, 1)) == "");
  CHECK(key(compared(2, {1}, 1)) == "values");
  CHECK(key(compared(3, {1, 2, 3}, 1)) == "values");  // one triad gives no scale
  CHECK(key(compared(4, {1, 2, 3, 4, 5}, 1)) == "");
  CHECK(key(compared(2, {1, 2, 2}, 1)) == "values");
  CHECK(key(compared(2, {1, 2, 3}, 0)) == "repeats");
  std::vector<double> many(50);
  std::iota(many.begin(), many.end(), 0);
  const auto most = [&](std::size_t together, int repeats) {
    const auto problems = validate(compared(together, many, repeats));
    return problems.empty() ? std::string() : core::say(problems.front().allowed, "en");
  };
  CHECK(most(2, 4) == "");  // 9800 trials
  CHECK(most(2, 5) == "at most 45 with this number of repeats");
  CHECK(most(3, 1) == "at most 40 with this number of repeats");
  CHECK(most(4, 1) == "at most 23 with this number of repeats");
  many.push_back(50);
  CHECK(most(2, 1) == "at most 50 with this number of repeats");
  CHECK(key(compared(3, {1, 2, 3, 4}, 10000)) == "repeats");
}
