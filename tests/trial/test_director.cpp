#include <filesystem>
#include <map>

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
      count.catches += spec->type == terms::TrialType::catch_trial ? 1 : 0;
      count.practice += spec->type == terms::TrialType::practice ? 1 : 0;
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
        disturbed.record({terms::Outcome::fault, {}, {}, {}});
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
