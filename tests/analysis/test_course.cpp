#include "station/analysis/course.hpp"

#include "station/core/draws.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

namespace {

TrialRecord answered(int index, int right, int response, double time_s) {
  TrialRecord trial;
  trial.trial_index = index;
  trial.level = right ? 10 : -10;
  trial.right_choice = right;
  trial.response = response;
  trial.correct = right == response;
  trial.response_time_s = time_s;
  return trial;
}

}  // namespace

TEST_CASE("A preference for one answer is detected, and guessing without a preference raises no alarm",
          "[analysis]") {
  std::vector<TrialRecord> fair, always;
  for (int i = 0; i < 60; ++i) {
    fair.push_back(answered(i, i % 2, i / 2 % 2, 0.5));
    always.push_back(answered(i, i % 2, 1, 0.5));
  }
  const auto none = choice_bias(fair), strong = choice_bias(always);
  CHECK(none->share_second == 0.5);
  CHECK(*none->criterion == Approx(0).margin(1e-12));
  CHECK(none->statements.empty());
  CHECK(strong->share_second == 1);
  CHECK(*strong->criterion < -1);
  REQUIRE(strong->statements.size() == 1);
  CHECK(strong->statements[0].code == "bias");
  CHECK_FALSE(choice_bias({}).has_value());
}

TEST_CASE("a catch trial that was not answered in time was not right", "[analysis]") {
  std::vector<TrialRecord> trials{answered(0, 1, 1, 0.5), answered(1, 0, 0, 0.5), answered(2, 1, 0, 0.5),
                                  answered(3, 1, 1, 0.5)};
  CHECK_FALSE(catch_accuracy(trials).has_value());
  for (auto& trial : trials) trial.type = TrialType::catch_trial;
  trials[3].outcome = Outcome::timeout;
  trials[3].correct.reset();
  const auto result = catch_accuracy(trials);
  CHECK(result->trials == 4);
  CHECK(result->right == 2);
  CHECK(result->interval.low < 0.12);
  // Nobody answers: 0 of 3, and void trials do not count.
  for (auto& trial : trials) trial.outcome = Outcome::timeout, trial.correct.reset(), trial.response.reset();
  trials[0].outcome = Outcome::fault;
  trials[1].outcome = Outcome::anticipation;
  CHECK(catch_accuracy(trials)->trials == 3);
  CHECK(catch_accuracy(trials)->right == 0);
}

TEST_CASE(
    "A trend over trials is estimated after removing the effect of level, and no trend is stated for few "
    "trials",
    "[analysis]") {
  std::vector<TrialRecord> slowing, steady;
  for (int i = 0; i < 80; ++i) {
    const double jitter = 0.02 * ((i * 7) % 5 - 2);
    slowing.push_back(answered(i, i % 2, i % 2, 0.5 + 0.002 * i + jitter));
    // The hard trials are slow and all come late. This looks like a trend unless the effect of level is
    // removed.
    steady.push_back(answered(i, i >= 40, i >= 40, (i >= 40 ? 0.9 : 0.5) + jitter));
  }
  const auto found = fatigue(slowing);
  CHECK(found.response_time_s->per_100_trials == Approx(0.2).margin(0.02));
  CHECK(found.statements.size() == 1);
  CHECK(fatigue(steady).statements.empty());
  slowing.resize(15);
  CHECK_FALSE(fatigue(slowing).response_time_s.has_value());
}

TEST_CASE("Traces show each procedure's trials in the order of presentation, without practice",
          "[analysis]") {
  std::vector<TrialRecord> trials;
  for (int i = 0; i < 6; ++i) {
    trials.push_back(answered(i, 1, 1, 0.5));
    trials.back().procedure = i % 2 ? "up" : "down";
    trials.back().level = i;
  }
  trials[0].type = TrialType::practice;
  const auto result = traces(trials);
  REQUIRE(result.size() == 2);
  CHECK(result[0].procedure == "up");
  CHECK(result[1].points.size() == 2);
  CHECK(result[1].points[0].trial_index == 2);
  const auto counts = count_outcomes(trials);
  CHECK(counts.presented == 5);
  CHECK(counts.answered == 5);
}

TEST_CASE("People who repeat their answers are found, and a run of equal stimuli does not look like them",
          "[analysis]") {
  for (const double habit : {0.0, 0.2}) {
    turnpoint::core::Draws draws({15, turnpoint::core::Stream::observer, 0, 0, 0});
    std::vector<TrialRecord> trials;
    int right = 0, last = 0, repeated = 0;
    for (int i = 0; i < 4000; ++i) {
      if (draws.uniform() < 0.3) right = 1 - right;  // stimuli come in runs
      TrialRecord trial;
      trial.trial_index = i;
      trial.right_choice = right;
      trial.response = draws.uniform() < 0.8 ? right : 1 - right;
      if (draws.uniform() < habit) trial.response = last;
      repeated += *trial.response == last;
      last = *trial.response;
      trials.push_back(trial);
    }
    const auto found = repetition(trials, "");
    REQUIRE(found);
    CHECK(repeated > 2200);  // the plain share is above a half for both
    CHECK((found->interval.low > 0) == (habit > 0));
    CHECK((habit > 0 || found->value < 0.03));
    CHECK_FALSE(repetition(trials, "another"));
  }
}

TEST_CASE("Post-error slowing is found, and a session that becomes slower and worse does not look like it",
          "[analysis]") {
  for (const double slowing_s : {0.0, 0.08}) {
    turnpoint::core::Draws draws({14, turnpoint::core::Stream::observer, 0, 0, 0});
    std::vector<TrialRecord> trials;
    bool after_error = false;
    double after = 0, other = 0;
    int errors = 0, others = 0;
    for (int i = 0; i < 2000; ++i) {
      TrialRecord trial;
      trial.trial_index = i;
      const double late = i / 2000.0;  // people tire: answers come later and are more often wrong
      trial.correct = draws.uniform() > 0.02 + 0.3 * late;
      trial.response_time_s = 0.5 + 0.4 * late + 0.05 * draws.normal() + (after_error ? slowing_s : 0);
      (after_error ? after : other) += *trial.response_time_s;
      ++(after_error ? errors : others);
      after_error = !*trial.correct;
      trials.push_back(trial);
    }
    const auto found = post_error_slowing(trials, "");
    REQUIRE(found);
    CHECK(found->interval.low < slowing_s);
    CHECK(slowing_s < found->interval.high);
    CHECK(found->interval.high - found->interval.low < 0.05);
    // the plain difference of the means finds a slowing of 0.08 s that does not exist
    if (slowing_s == 0) CHECK(after / errors - other / others > 0.05);
    CHECK_FALSE(post_error_slowing(trials, "another"));
    for (auto& trial : trials) trial.block_index = trial.trial_index / 3;  // no run of four in a block
    CHECK_FALSE(post_error_slowing(trials, ""));
  }
}
