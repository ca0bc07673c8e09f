#include <cmath>
#include <set>

#include "station/core/usage_error.hpp"
#include "station/procedure/trace.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

Spec two_down_one_up() {
  Spec spec;
  spec.name = "stairs";
  spec.level = "level";
  spec.kind = Kind::up_down;
  spec.start = 20;
  spec.step = {4, 2, 1};
  spec.n_down = 2;
  spec.initial_down = 1;
  spec.stop.trials = 100;
  return spec;
}

}  // namespace

TEST_CASE("2-down-1-up with an initial 1-down rule steps and reverses as Levitt describes", "[procedure]") {
  const auto result = trace(two_down_one_up(), {}, "11101110011");
  CHECK(result.levels == std::vector<double>{20, 16, 12, 8, 10, 10, 9, 9, 10, 11, 11});
  CHECK(result.reversals == std::vector<double>{8, 10, 9, 11});
}

TEST_CASE("a staircase averages the reversals that the protocol chose, and says which", "[procedure]") {
  auto spec = two_down_one_up();  // the answers below give reversals at 8, 10, 9, 11
  const auto estimate = [&spec](int discard) {
    spec.discard_reversals = discard;
    return trace(spec, {}, "11101110011").estimates;
  };
  CHECK(estimate(0).at("threshold").mean == 9.5);
  CHECK(estimate(0).at("threshold").basis == "reversals 1 to 4 of 4");
  CHECK(estimate(2).at("threshold").mean == 10);
  CHECK(estimate(2).at("threshold").basis == "reversals 3 to 4 of 4");
  // Three reversals remain, an odd number, so the first of them is dropped.
  CHECK(estimate(1).at("threshold").mean == 10);
  CHECK(estimate(1).at("threshold").basis == "reversals 3 to 4 of 4");
  CHECK(estimate(3).empty());
  spec.stop.reversals = 4;
  CHECK(validate(spec).size() == 1);
  CHECK(validate(spec).front().key == "discard_reversals");
  spec.discard_reversals = 2;
  CHECK(validate(spec).empty());
}

TEST_CASE("a weighted staircase balances at its target", "[procedure]") {
  Spec spec;
  spec.name = "q75";
  spec.level = "offset_mm";
  spec.kind = Kind::weighted_up_down;
  spec.start = 20;
  spec.min = -25;
  spec.max = 25;
  spec.step_down = {4, 2, 1};
  spec.target = 0.75;
  spec.stop.trials = 40;
  // The step up is three times the step down, so one wrong answer cancels three right ones.
  CHECK(trace(spec, {}, "1110").levels == std::vector<double>{20, 16, 12, 8});
  CHECK(*trace(spec, {}, "1110").next == Approx(14));
}

TEST_CASE("after \"unsure\" a weighted staircase steps as it would, on average, after a guess",
          "[procedure]") {
  Spec spec;
  spec.name = "unforced";
  spec.level = "contrast_dB";
  spec.kind = Kind::weighted_up_down;
  spec.start = 20;
  spec.min = -40;
  spec.max = 40;
  spec.step_down = {2, 1};
  spec.target = 0.75;
  spec.stop.trials = 4000;
  spec.guess_rate = 0.5;
  const auto start = [&] {
    return make_procedure(spec, {}, {1, turnpoint::core::Stream::level_order, 0, 0, 0});
  };
  const auto level = [](const Procedure& procedure) { return procedure.next()->level; };
  auto steps = start();
  steps->record(Answer::one);
  CHECK(level(*steps) == 18);
  steps->record(Answer::unsure);  // up, which is a reversal, so that the second size follows
  CHECK(level(*steps) == 19);
  steps->record(Answer::unsure);
  CHECK(level(*steps) == 20);
  steps->record(Answer::zero);
  CHECK(level(*steps) == 23);

  // With one of three right by chance and a target of 0.8: the mean of 2/3 of 4 up and 1/3 of 1 down.
  spec.guess_rate = 1.0 / 3;
  spec.target = 0.8, spec.step_down = {1};
  steps = start();
  steps->record(Answer::unsure);
  CHECK(level(*steps) == Approx(20 + 8.0 / 3 - 1.0 / 3));

  // Whether people guess or not, the level settles where 75 % would be right. They know the answer with the
  // probability 1 - exp(-e), e = 10^(level / 20), and otherwise guess or say that they would.
  spec.guess_rate = 0.5, spec.target = 0.75, spec.step_down = {2, 1};
  for (const double admits : {0.0, 0.5, 1.0}) {
    auto track = start();
    turnpoint::core::Draws draws({5, turnpoint::core::Stream::observer, 0, 0, static_cast<int>(10 * admits)});
    double sum = 0;
    int counted = 0;
    for (int i = 0; i < 4000; ++i) {
      const double at = level(*track);
      const double known = 1 - std::exp(-std::pow(10, at / 20));
      sum += known + 0.5 * (1 - known), ++counted;
      const bool knows = draws.uniform() < known;
      const bool admitted = draws.uniform() < admits, lucky = draws.uniform() < 0.5;
      track->record(knows ? Answer::one : admitted ? Answer::unsure : lucky ? Answer::one : Answer::zero);
    }
    INFO("admits " << admits << " of the guesses");
    CHECK(sum / counted == Approx(0.75).margin(0.02));
  }
}

TEST_CASE("a staircase stays inside its limits and stops by its rules", "[procedure]") {
  auto spec = two_down_one_up();
  spec.initial_down.reset();
  spec.n_down = 1;
  spec.min = 10;
  spec.stop = {};
  spec.stop.reversals = 2;
  const auto result = trace(spec, {}, "1111101");
  CHECK(result.levels.back() == 12);
  CHECK_FALSE(result.next.has_value());
  CHECK_THROWS_AS(trace(spec, {}, "11111011"), turnpoint::core::UsageError);
}

TEST_CASE("on a logarithmic scale steps multiply and the mean of reversals is a mean of logs",
          "[procedure]") {
  auto spec = two_down_one_up();
  spec.scale = Scale::log10;
  spec.start = 100;
  spec.n_down = 1;
  spec.initial_down.reset();
  spec.step = {1};
  const auto result = trace(spec, {}, "110100");
  CHECK(result.levels[1] == Approx(10));
  CHECK(result.levels[2] == Approx(1));
  CHECK(result.estimates.at("threshold").mean == Approx(std::sqrt(10.0)).epsilon(1e-12));
}

TEST_CASE("a staircase that cannot run is refused with the key and what is allowed", "[procedure]") {
  auto spec = two_down_one_up();
  spec.stop = {};
  CHECK_THROWS_AS(make_procedure(spec, {}, {}), std::invalid_argument);
  spec = two_down_one_up();
  spec.step = {0};
  CHECK_FALSE(validate(spec).empty());
}

TEST_CASE("a procedure ends even if the observer never answers", "[procedure]") {
  auto spec = two_down_one_up();
  spec.stop = {};
  spec.stop.reversals = 8;
  const auto procedure = make_procedure(spec, {}, {});
  int asked = 0;
  for (; procedure->next() && asked < 1000; ++asked) {
    CHECK(procedure->next()->level == 20);
    procedure->record(Answer::none);
  }
  CHECK(asked == 80);
  CHECK(procedure->recorded() == 0);
}

namespace {

/// A staircase from 0.4 in steps of 0.1 that ends after eight reversals.
Spec by_tenths(Scale scale, double start, double min, double max, double step) {
  Spec spec;
  spec.name = "tenths";
  spec.level = "level";
  spec.kind = Kind::up_down;
  spec.scale = scale;
  spec.start = start, spec.min = min, spec.max = max;
  spec.step = {step};
  spec.stop.trials = 4000;
  spec.stop.limit_steps = 1000;
  return spec;
}

}  // namespace

TEST_CASE("a level is the same to the last bit however it was reached, and 0 is 0", "[procedure]") {
  struct Case {
    Scale scale;
    double start, min, max, step;
    std::size_t levels;  ///< number of whole steps between min and max, ends included
  };
  // 0.07 cannot reach the limits 0 and 0.5 from 0.4: its levels are 0.05, 0.12, ..., 0.47.
  for (const auto& c : {Case{Scale::linear, 0.4, 0, 0.5, 0.1, 6}, Case{Scale::linear, 0.4, 0, 0.5, 0.07, 7},
                        Case{Scale::linear, -0.3, -0.6, 0.6, 0.05, 25},
                        Case{Scale::log10, 100, 1, 1000, 0.1, 31}, Case{Scale::dB, 8, 0.5, 32, 0.5, 73}}) {
    const auto procedure = make_procedure(by_tenths(c.scale, c.start, c.min, c.max, c.step), {}, {});
    std::set<double> levels;
    std::uint64_t random = 12345;
    for (int trial = 0; trial < 3000; ++trial) {
      const double level = procedure->next()->level;
      levels.insert(level);
      random = random * 6364136223846793005u + 1442695040888963407u;
      // Walk from one end to the other, with random steps on the way.
      const bool down = (trial / 150) % 2 == 0 ? (random >> 60) < 13 : (random >> 60) < 3;
      procedure->record(down ? Answer::one : Answer::zero);
    }
    INFO(c.start << " " << c.step);
    CHECK(levels.size() == c.levels);
    if (c.scale == Scale::linear)
      for (const double level : levels) CHECK(level == std::round(level * 100) / 100);
    if (c.step < 0.3 && c.step != 0.07) CHECK(*levels.begin() == c.min);
    if (c.step < 0.3 && c.step != 0.07) CHECK(*levels.rbegin() == c.max);
  }
}

TEST_CASE("steps without a common one are counted too, and begin again at a limit", "[procedure]") {
  auto spec = by_tenths(Scale::linear, 1, 0, 2, 0.1);
  spec.kind = Kind::weighted_up_down;
  spec.target = 0.7071;
  // Up by one step up and down again by ratios that do not divide it: the same counts give the same level.
  const auto one = trace(spec, {}, "10110").levels, other = trace(spec, {}, "11010").levels;
  CHECK(*trace(spec, {}, "10110").next == *trace(spec, {}, "11010").next);
  CHECK(one != other);
}

TEST_CASE("a track ends after ten steps at the end of its range, and after its largest number of trials",
          "[procedure]") {
  const auto run = [](const Spec& spec, auto&& answer) {
    const auto procedure = make_procedure(spec, {}, {});
    int trials = 0;
    while (procedure->next()) procedure->record(answer(trials++));
    return std::pair(trials, procedure->ended());
  };
  auto spec = by_tenths(Scale::linear, 0.4, 0, 0.5, 0.1);
  spec.n_down = 3;
  spec.stop = {};
  spec.stop.reversals = 8;
  const auto right = [](int) { return Answer::one; };
  const auto wrong = [](int) { return Answer::zero; };
  // Four steps to 0, then ten that the limit stops, of three right answers each.
  CHECK(run(spec, right) == std::pair(42, Ended::limit));
  CHECK(run(spec, wrong) == std::pair(11, Ended::limit));
  spec.stop.limit_steps = 2;
  CHECK(run(spec, right) == std::pair(18, Ended::limit));
  // The same with rules that must all be met, with a step that does not reach the limit, and on a log scale.
  spec.stop.trials = 100, spec.stop.rule = StopRule::all, spec.stop.limit_steps = {};
  CHECK(run(spec, right).second == Ended::limit);
  spec.step = {0.07};
  CHECK(run(spec, right).second == Ended::limit);
  spec.scale = Scale::log10, spec.min = 0.01;
  CHECK(run(spec, right).second == Ended::limit);
  auto approximation = spec;
  approximation.kind = Kind::accelerated_stochastic_approximation;
  approximation.target = 0.75;
  CHECK(run(approximation, right).second == Ended::limit);
  // Many small steps never reach the end: the largest number of trials ends them.
  spec.step = {1e-5}, spec.scale = Scale::linear, spec.stop = {};
  spec.stop.reversals = 8;
  CHECK(run(spec, right) == std::pair(400, Ended::most));
  spec.stop.max_trials = 50;
  CHECK(run(spec, right) == std::pair(50, Ended::most));
  // A track whose rules are met has ended by its rules, wherever it is.
  spec.stop = {};
  spec.stop.trials = 20;
  CHECK(run(spec, right) == std::pair(20, Ended::rule));
}
