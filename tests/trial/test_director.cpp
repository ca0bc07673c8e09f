#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "station/trial/director.hpp"
#include "station/trial/question.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::trial;

namespace {

protocol::Protocol shipped(const std::string& name) {
  return protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

TrialEnd answered(const TrialSpec& spec, bool right) {
  TrialEnd end;
  const int answer = spec.correct.value_or(0);
  end.response = right ? answer : 1 - answer;
  if (spec.correct) end.correct = right;
  return end;
}

struct Count {
  int trials = 0, catches = 0, practice = 0;
};

Count run_through(Director& director, bool right = true) {
  Count count;
  while (director.block() != nullptr) {
    while (const auto spec = director.next()) {
      ++count.trials;
      count.catches += spec->type == core::TrialType::catch_trial ? 1 : 0;
      count.practice += spec->type == core::TrialType::practice ? 1 : 0;
      director.record(answered(*spec, right));
    }
    director.finish_block();
  }
  return count;
}

}  // namespace

TEST_CASE("a void trial is presented again unchanged, and does not change later trials", "[session]") {
  const auto protocol = shipped("boundary-constant");
  Director smooth(protocol, 0, 11), disturbed(protocol, 0, 11);
  int trial = 0;
  while (smooth.block() != nullptr) {
    while (const auto expected = smooth.next()) {
      auto spec = disturbed.next();
      REQUIRE(spec.has_value());
      if (trial % 5 == 2) {
        disturbed.record({core::Outcome::fault, {}, {}, {}});
        spec = disturbed.next();
      }
      CHECK(spec->level == expected->level);
      CHECK(spec->factors == expected->factors);
      CHECK(spec->rove_dB == expected->rove_dB);
      CHECK(spec->iti_s == expected->iti_s);
      smooth.record(answered(*expected, true));
      disturbed.record(answered(*spec, true));
      CHECK(smooth.state_hash() == disturbed.state_hash());
      ++trial;
    }
    smooth.finish_block();
    disturbed.finish_block();
  }
  CHECK(disturbed.block() == nullptr);
}

TEST_CASE("practice that is not passed is repeated and then ends the session with the reason", "[session]") {
  const auto protocol = shipped("boundary-constant");
  Director director(protocol, 0, 3);
  REQUIRE(director.block()->pass.has_value());
  const auto count = run_through(director, false);
  CHECK(count.trials == count.practice);
  CHECK(director.ended_because().find("practice") != std::string::npos);
}

TEST_CASE("a block of a fixed time ends with the trial that fills it, and void trials take none of it",
          "[session]") {
  auto protocol = shipped("demo");
  auto& block = std::get<protocol::Block>(protocol.plan.front());
  block.procedures.resize(1), block.lasts_s = 10;
  Director director(protocol, 0, 11);
  for (const double trial_s : {4.0, 5.9, 0.2}) {
    auto spec = director.next();
    REQUIRE(spec);
    director.record({core::Outcome::fault, {}, {}, {}});
    director.spend(100);
    spec = director.next();
    REQUIRE(spec);
    director.record(answered(*spec, true));
    director.spend(trial_s);
  }
  CHECK_FALSE(director.next());
  CHECK(director.block() != nullptr);
  director.finish_block();
  CHECK(director.block() == nullptr);
}

TEST_CASE("catch trials occur at about their rate, and the procedure does not learn from them", "[session]") {
  const auto protocol = shipped("friction-2ifc");
  int catches = 0, trials = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Director director(protocol, 0, seed);
    const auto count = run_through(director);
    catches += count.catches;
    trials += count.trials - count.practice;
  }
  CHECK(catches / static_cast<double>(trials) == Approx(0.06).margin(0.03));
}

TEST_CASE("the same seed gives the same session, and another seed gives another session", "[session]") {
  const auto protocol = shipped("boundary-constant");
  const auto levels = [&protocol](std::uint64_t seed) {
    std::vector<double> all;
    Director director(protocol, 0, seed);
    while (director.block() != nullptr) {
      while (const auto spec = director.next()) {
        all.push_back(*spec->level);
        director.record(answered(*spec, true));
      }
      director.finish_block();
    }
    return all;
  };
  CHECK(levels(5) == levels(5));
  CHECK(levels(5) != levels(6));
}

TEST_CASE(
    "an observer without a threshold of its own gets the middle of the protocol's levels, also for "
    "staircases",
    "[session]") {
  const auto protocol =
      protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/friction-staircase.toml");
  trial::Director director(protocol, 0, 1);
  const auto practice = director.next();
  REQUIRE(practice);
  trial::TrialSpec stair = *practice;
  stair.procedure = protocol.procedures.back().name;
  for (const auto& spec : {*practice, stair}) {
    const auto question = trial::question_of(spec, protocol, 1);
    CHECK(question.default_threshold == Approx(-18.5));  // the middle of the limits -34 and -3 dB
    CHECK(question.decibel);
  }
}

TEST_CASE("a simulated observer compares what the intervals present, in their order", "[session]") {
  const auto protocol = shipped("friction-pairs");
  Director director(protocol, 0, 1);
  auto trial = director.next().value();
  const auto forth = trial::question_of(trial, protocol, 1);
  REQUIRE(forth.compared.size() == 2);
  CHECK(forth.level != 0);
  std::swap(trial.intervals[0], trial.intervals[1]);
  const auto back = trial::question_of(trial, protocol, 1);
  CHECK(back.compared == std::vector{forth.compared[1], forth.compared[0]});
  CHECK(back.level == -forth.level);
  trial.intervals[1] = trial.intervals[0];
  CHECK(trial::question_of(trial, protocol, 1).level == 0);
}

TEST_CASE("the times of a trial follow its factors", "[session]") {
  auto protocol = shipped("response-signal");
  Director signalled(protocol, 0, 5);
  std::map<double, int> lags;
  signalled.finish_block();  // leave the practice block
  while (const auto spec = signalled.next()) {
    const double lag_s = std::get<double>(spec->factors.at("lag_s"));
    ++lags[lag_s];
    REQUIRE(spec->signal_s == lag_s);
    CHECK(spec->anticipation_s == lag_s);
    CHECK(spec->deadline_s == Approx(lag_s + 0.4));
    CHECK_FALSE(spec->timeouts_are_data);
    signalled.record(answered(*spec, true));
  }
  CHECK(lags == std::map<double, int>{{0.1, 56}, {0.2, 56}, {0.35, 56}, {0.6, 56}, {1.0, 56}, {1.6, 56}});

  protocol.timing.deadline_s = protocol.timing.signal->after_s;
  protocol.timing.signal.reset();
  Director limited(protocol, 0, 5);
  for (int i = 0; i < 20; ++i) {
    const auto spec = limited.next();
    CHECK(spec->deadline_s == std::get<double>(spec->factors.at("lag_s")));
    CHECK_FALSE(spec->signal_s);
    limited.record(answered(*spec, true));
  }
}

TEST_CASE("each of the interleaved procedures presents its own value of the factor", "[session]") {
  const auto protocol = shipped("friction-weber");
  Director director(protocol, 0, 8);
  director.finish_block();  // leave the practice block
  std::map<std::string, int> trials;
  std::map<std::string, int> followed;  // how often each procedure was followed by another one
  std::string last;
  while (const auto spec = director.next()) {
    const double reference = std::get<double>(spec->factors.at("reference"));
    CHECK(spec->procedure == "weber-0_" + std::to_string(static_cast<int>(100 * reference + 0.5)));
    ++trials[spec->procedure];
    followed[last] += last != spec->procedure;
    last = spec->procedure;
    // The answers depend on the reference, so the three procedures reach different levels if each has a state
    // of its own.
    director.record(answered(*spec, reference > 0.7 || trials[spec->procedure] % 2 == 0));
  }
  CHECK(trials == std::map<std::string, int>{{"weber-0_65", 40}, {"weber-0_75", 40}, {"weber-0_85", 40}});
  for (const auto& [procedure, count] : trials) CHECK(followed[procedure] > 15);
  std::map<std::string, double> thresholds;
  for (const auto& estimate : director.estimates())
    if (estimate.parameter == "threshold") thresholds[estimate.procedure] = estimate.mean;
  CHECK(thresholds.at("weber-0_65") > 3 * thresholds.at("weber-0_75"));
  CHECK(thresholds.at("weber-0_75") == Approx(thresholds.at("weber-0_85")).epsilon(0.5));
}

TEST_CASE("values are drawn from a range as the protocol says", "[session]") {
  auto protocol = shipped("friction-weber");
  auto& factor = protocol.factors.at(2);
  REQUIRE(factor.name == "end_mm");
  const auto drawn = [&] {
    std::vector<double> values;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      Director director(protocol, 0, seed);
      director.finish_block();
      while (const auto spec = director.next()) {
        values.push_back(std::get<double>(spec->factors.at("end_mm")));
        director.record(answered(*spec, true));
      }
    }
    return values;
  };
  const auto moments = [](const std::vector<double>& values) {
    double sum = 0, squares = 0;
    for (const double value : values) sum += value;
    const double mean = sum / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::pair(mean, std::sqrt(squares / static_cast<double>(values.size() - 1)));
  };
  // 4800 values. The limits are four standard errors of mean and standard deviation.
  const auto uniform = drawn();
  REQUIRE(uniform.size() == 4800);
  CHECK(*std::min_element(uniform.begin(), uniform.end()) >= 180);
  CHECK(*std::max_element(uniform.begin(), uniform.end()) <= 190);
  CHECK(moments(uniform).first == Approx(185).margin(0.17));
  CHECK(moments(uniform).second == Approx(10 / std::sqrt(12.0)).margin(0.08));

  factor.draw = protocol::FactorDraw::normal;
  factor.mean = 185, factor.sd = 1;
  // the range, 180 to 190, is 5 standard deviations wide on either side of the mean
  const auto normal = drawn();
  CHECK(moments(normal).first == Approx(185).margin(0.06));
  CHECK(moments(normal).second == Approx(1).margin(0.042));
  factor.sd = 10;  // values outside of the range are drawn again
  for (const double value : drawn()) CHECK((value >= 180 && value <= 190));
}

TEST_CASE("without repetition, each level comes once before any comes again", "[session]") {
  auto protocol = shipped("friction-weber");
  auto& factor = protocol.factors.at(2);
  factor.range.reset();
  factor.levels = {180.0, 183.0, 185.0, 188.0, 190.0};
  factor.draw = protocol::FactorDraw::without_repetition;
  Director director(protocol, 0, 8);
  director.finish_block();
  std::set<double> round;
  std::set<std::vector<double>> orders;
  std::vector<double> order;
  while (const auto spec = director.next()) {
    const double value = std::get<double>(spec->factors.at("end_mm"));
    CHECK(round.insert(value).second);
    order.push_back(value);
    if (round.size() == 5) round.clear(), orders.insert(std::exchange(order, {}));
    if (order.size() == 3) {  // a void trial is presented again with the same value
      director.record({core::Outcome::fault, {}, {}, {}});
      CHECK(std::get<double>(director.next()->factors.at("end_mm")) == value);
    }
    director.record(answered(*spec, true));
  }
  CHECK(order.empty());
  CHECK(orders.size() > 10);  // the 24 rounds of the block must have more than 10 different orders
}

TEST_CASE("a procedure over two dimensions sets both factors of a trial, and the observer feels both",
          "[session]") {
  const auto protocol = shipped("friction-boundary-2d");
  Director director(protocol, 0, 8);
  const auto practice = director.next();  // the second factor has levels, from which practice draws
  CHECK(std::get<double>(practice->factors.at("end_mm")) >= 120);
  director.finish_block();
  const auto& spec = protocol.procedures.front();
  std::map<double, int> ends;
  int trials = 0;
  while (const auto trial = director.next()) {
    const double end_mm = std::get<double>(trial->factors.at("end_mm"));
    const double contrast_dB = std::get<double>(trial->factors.at("contrast_dB"));
    CHECK(contrast_dB == trial->level);
    CHECK(std::find(spec.second->stimuli.values.begin(), spec.second->stimuli.values.end(), end_mm) !=
          spec.second->stimuli.values.end());
    const auto question = question_of(*trial, protocol, 8);
    CHECK(question.second == end_mm - 150);
    CHECK(question.log_step == 0);
    ++ends[end_mm], ++trials;
    director.record(answered(*trial, contrast_dB > -15));
  }
  CHECK(trials == 96);
  CHECK(ends.size() > 1);
  std::set<std::string> parameters;
  for (const auto& estimate : director.estimates()) {
    parameters.insert(estimate.parameter);
    REQUIRE(estimate.interval);
    CHECK((estimate.interval->first <= estimate.mean && estimate.mean <= estimate.interval->second));
  }
  CHECK(parameters == std::set<std::string>{"gradient", "lapse", "slope", "threshold"});
}

TEST_CASE("a warm-up trial of a procedure over two dimensions has a value of both", "[session]") {
  auto protocol = shipped("friction-boundary-2d");
  auto& factor = protocol.factors.at(1);
  REQUIRE(factor.name == "end_mm");
  factor.levels.clear(), factor.range = {120.0, 180.0};
  Director director(protocol, 0, 8);
  director.finish_block();
  director.warm_up(1);
  const auto trial = director.next();
  CHECK(trial->type == core::TrialType::warmup);
  CHECK(std::get<double>(trial->factors.at("end_mm")) == 150);
}

TEST_CASE("the progress never reaches its end before the last trial, however many trials are repeated",
          "[session]") {
  const auto* name =
      GENERATE("boundary-constant", "boundary-adaptive", "demo", "friction-2ifc", "two-spots-oddity");
  const int unanswered_every = GENERATE(0, 3);
  CAPTURE(name, unanswered_every);
  const auto protocol = shipped(name);
  Director director(protocol, 0, 7);
  int number = 0;
  while (director.block() != nullptr && number < 3000) {
    while (const auto spec = director.next()) {
      REQUIRE(director.trials_done() < director.trials_expected());
      ++number;
      if (unanswered_every > 0 && number % unanswered_every == 0)
        director.record({core::Outcome::timeout, {}, {}, {}});
      else
        director.record(answered(*spec, number % 4 != 1));
    }
    director.finish_block();
  }
  CHECK(number < 3000);
  CHECK(director.trials_done() == director.trials_expected());
}

TEST_CASE("the expected trials have those that a list with rules of its order begins with", "[session]") {
  CHECK(Director(shipped("bisection"), 0, 7).trials_expected() == 99);  // 7 levels x 14 and one more
}
