#include "station/rehearsal/one_cue.hpp"

#include <algorithm>

#include "tests/support/catch.hpp"

using namespace turnpoint;
using protocol::TaskKind;
using rehearsal::Asked;
using rehearsal::Look;

namespace {

const Asked single_interval{TaskKind::single_interval, 1, 2};

Look single(double value, int answer, double weight = 1) { return {{value}, answer, weight}; }

double best(const Asked& asked, const std::vector<Look>& looks,
            const rehearsal::Grain& grain = {1e-3, 1e-3}) {
  return rehearsal::accuracy(rehearsal::best_rule(asked, looks, grain), asked, looks);
}

}  // namespace

TEST_CASE(
    "the best criterion is found in either direction; a cue that reveals nothing gives one constant answer",
    "[cues]") {
  CHECK(best(single_interval, {single(1, 0), single(2, 0), single(3, 1), single(4, 1)}) == 1);
  CHECK(best(single_interval, {single(1, 1), single(2, 1), single(3, 0), single(4, 0)}) == 1);
  CHECK(best(single_interval, {single(5, 1), single(5, 1), single(5, 0)}) == Approx(2.0 / 3));
  CHECK(best(single_interval, {single(5, 1, 1), single(6, 0, 3)}) == 1);
  CHECK(best(single_interval, {single(5, 1, 1), single(5.0005, 0, 3)}) == Approx(0.75));
  CHECK(rehearsal::accuracy({}, single_interval, {}) == 0);
}

TEST_CASE("a band in the middle of the cue's values is found, but none in values that alternate", "[cues]") {
  CHECK(best(single_interval, {single(1, 0), single(2, 1), single(3, 1), single(4, 0)}) == 1);
  CHECK(best(single_interval, {single(1, 0), single(2, 1), single(3, 0), single(4, 1)}) == Approx(0.75));
}

TEST_CASE("with two intervals, the rule chooses the larger, the smaller or the unusual one", "[cues]") {
  const Asked two{TaskKind::two_interval, 2, 2};
  CHECK(best(two, {{{1, 2, 0}, 1, 1}, {{2, 1, 0}, 0, 1}}) == 1);
  CHECK(best(two, {{{1, 2, 0}, 0, 1}, {{2, 1, 0}, 1, 1}}) == 1);
  CHECK(best(two, {{{5, 4, 0}, 1, 1}, {{4, 5, 0}, 0, 1}, {{5, 6, 0}, 1, 1}, {{6, 5, 0}, 0, 1}}) == 1);
  CHECK(best(two, {{{5, 5.0005, 0}, 1, 1}, {{5.0005, 5, 0}, 0, 1}}) == Approx(0.5));
}

TEST_CASE(
    "same and different pairs are recognised by the size of the difference, whichever interval is larger",
    "[cues]") {
  const Asked pair{TaskKind::same_different, 2, 2};
  CHECK(best(pair, {{{1, 1, 0}, 0, 1}, {{2, 2, 0}, 0, 1}, {{1, 2, 0}, 1, 1}, {{2, 1, 0}, 1, 1}}) == 1);
  CHECK(best(pair, {{{1, 1, 0}, 0, 1}, {{1, 1, 0}, 1, 1}}) == Approx(0.5));
}

TEST_CASE("with three intervals the odd one is found, and equal intervals are guessed", "[cues]") {
  const Asked three{TaskKind::oddity, 3, 3};
  CHECK(best(three, {{{1, 1, 2}, 2, 1}, {{2, 1, 2}, 1, 1}}) == 1);
  CHECK(best(three, {{{1, 1, 1}, 2, 1}, {{1, 1, 1}, 0, 1}}) == Approx(1.0 / 3));
}

TEST_CASE("with more answers, neighbouring ranges of the cue are found, in any order of the answers",
          "[cues]") {
  const Asked three{TaskKind::single_interval, 1, 3};
  CHECK(best(three, {single(1, 2), single(2, 0), single(3, 1), single(4, 1)}) == 1);
  // with four ranges of the cue's value
  CHECK(best(three, {single(1, 0), single(2, 1), single(3, 2), single(4, 0)}) == 1);
  CHECK(best(three, {single(1, 0), single(2, 1), single(3, 2), single(4, 0), single(5, 1), single(6, 2)}) ==
        Approx(4.0 / 6));
  CHECK(best(three, {single(5, 0), single(5, 1), single(5, 2), single(5, 2)}) == Approx(0.5));
}

TEST_CASE("of four intervals the one with the target is found; X is matched in any position", "[cues]") {
  const Asked four{TaskKind::several_intervals, 4, 4};
  CHECK(best(four, {{{1, 1, 1, 2}, 3, 1}, {{2, 1, 1, 1}, 0, 1}}) == 1);
  CHECK(best(four, {{{1, 1, 1, 1}, 3, 1}, {{1, 1, 1, 1}, 0, 1}}) == Approx(0.25));
  const Asked abx{TaskKind::abx, 3, 2}, sample{TaskKind::match_to_sample, 3, 2};
  CHECK(best(abx, {{{1, 2, 2}, 1, 1}, {{1, 2, 1}, 0, 1}, {{2, 1, 2}, 0, 1}}) == 1);
  CHECK(best(sample, {{{2, 1, 2}, 1, 1}, {{1, 1, 2}, 0, 1}, {{2, 2, 1}, 0, 1}}) == 1);
  CHECK(best(abx, {{{1, 1, 1}, 1, 1}, {{1, 1, 1}, 0, 1}}) == Approx(0.5));
}

TEST_CASE("ranges of a cue may end between different values, at no more places than are asked for",
          "[cues]") {
  std::vector<Look> looks;
  for (int k = 0; k < 10; ++k) looks.push_back(single(k, k >= 6 ? 0 : 1));
  const auto all = rehearsal::places(looks, {1e-3, 0}, 96);
  REQUIRE(all.size() == 9);  // one between each two neighbours
  for (std::size_t k = 0; k < all.size(); ++k) CHECK(all[k] == Approx(static_cast<double>(k) + 0.5));
  CHECK(rehearsal::places(looks, {1e-3, 0}, 3) == std::vector<double>{2.5, 4.5, 7.5});
  CHECK(rehearsal::places(looks, {1.5, 0}, 96) == std::vector<double>{1.5, 3.5, 5.5, 7.5});
  CHECK(rehearsal::places({single(5, 0), single(5, 1)}, {1e-3, 0}, 9).empty());
}

TEST_CASE("ranges of a cue may end on both sides of a value that occurs often", "[cues]") {
  std::vector<Look> looks;
  for (int k = 0; k < 100; ++k) looks.push_back(single(k, 1));
  looks.push_back(single(41.5, 0, 100));
  const auto some = rehearsal::places(looks, {1e-3, 0}, 5);
  for (const double beside : {41.25, 41.75}) CHECK(std::count(some.begin(), some.end(), beside) == 1);
  CHECK(some.size() <= 7);
}
