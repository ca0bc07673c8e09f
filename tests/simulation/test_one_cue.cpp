#include "station/simulation/one_cue.hpp"

#include "tests/support/catch.hpp"

using namespace turnpoint;
using protocol::TaskKind;
using simulation::Look;

namespace {

Look single(double value, int answer, double weight = 1) { return {{value, 0, 0}, answer, weight}; }

double best(TaskKind task, const std::vector<Look>& looks, const simulation::Grain& grain = {1e-3, 1e-3}) {
  return simulation::accuracy(simulation::best_rule(task, looks, grain), task, looks);
}

}  // namespace

TEST_CASE(
    "the best criterion is found in either direction; a cue that reveals nothing gives one constant answer",
    "[cues]") {
  CHECK(best(TaskKind::single_interval, {single(1, 0), single(2, 0), single(3, 1), single(4, 1)}) == 1);
  CHECK(best(TaskKind::single_interval, {single(1, 1), single(2, 1), single(3, 0), single(4, 0)}) == 1);
  CHECK(best(TaskKind::single_interval, {single(5, 1), single(5, 1), single(5, 0)}) == Approx(2.0 / 3));
  CHECK(best(TaskKind::single_interval, {single(5, 1, 1), single(6, 0, 3)}) == 1);
  CHECK(best(TaskKind::single_interval, {single(5, 1, 1), single(5.0005, 0, 3)}) == Approx(0.75));
  CHECK(simulation::accuracy({}, TaskKind::single_interval, {}) == 0);
}

TEST_CASE("a band in the middle of the cue's values is found, but none in values that alternate", "[cues]") {
  CHECK(best(TaskKind::single_interval, {single(1, 0), single(2, 1), single(3, 1), single(4, 0)}) == 1);
  CHECK(best(TaskKind::single_interval, {single(1, 0), single(2, 1), single(3, 0), single(4, 1)}) ==
        Approx(0.75));
}

TEST_CASE("with two intervals, the rule chooses the larger, the smaller or the unusual one", "[cues]") {
  const auto two = TaskKind::two_interval;
  CHECK(best(two, {{{1, 2, 0}, 1, 1}, {{2, 1, 0}, 0, 1}}) == 1);
  CHECK(best(two, {{{1, 2, 0}, 0, 1}, {{2, 1, 0}, 1, 1}}) == 1);
  CHECK(best(two, {{{5, 4, 0}, 1, 1}, {{4, 5, 0}, 0, 1}, {{5, 6, 0}, 1, 1}, {{6, 5, 0}, 0, 1}}) == 1);
  CHECK(best(two, {{{5, 5.0005, 0}, 1, 1}, {{5.0005, 5, 0}, 0, 1}}) == Approx(0.5));
}

TEST_CASE(
    "same and different pairs are recognised by the size of the difference, whichever interval is larger",
    "[cues]") {
  const auto pair = TaskKind::same_different;
  CHECK(best(pair, {{{1, 1, 0}, 0, 1}, {{2, 2, 0}, 0, 1}, {{1, 2, 0}, 1, 1}, {{2, 1, 0}, 1, 1}}) == 1);
  CHECK(best(pair, {{{1, 1, 0}, 0, 1}, {{1, 1, 0}, 1, 1}}) == Approx(0.5));
}

TEST_CASE("with three intervals the odd one is found, and equal intervals are guessed", "[cues]") {
  const auto three = TaskKind::oddity;
  CHECK(best(three, {{{1, 1, 2}, 2, 1}, {{2, 1, 2}, 1, 1}}) == 1);
  CHECK(best(three, {{{1, 1, 1}, 2, 1}, {{1, 1, 1}, 0, 1}}) == Approx(1.0 / 3));
}
