#include "station/analysis/confusion.hpp"

#include "station/analysis/proportion.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

namespace {

TrialRecord answered(std::optional<int> right, int response, double level = 0) {
  TrialRecord trial;
  trial.right_choice = right, trial.response = response, trial.level = level;
  if (right) trial.correct = *right == response;
  return trial;
}

}  // namespace

TEST_CASE("a confusion matrix counts answers by the right answer, with Clopper-Pearson intervals",
          "[analysis]") {
  std::vector<TrialRecord> trials;
  for (int i = 0; i < 20; ++i) trials.push_back(answered(0, i < 15 ? 0 : i < 18 ? 1 : 2));
  for (int i = 0; i < 4; ++i) trials.push_back(answered(2, 2));
  auto timeout = answered(0, 0);
  timeout.response.reset(), timeout.outcome = Outcome::timeout;
  auto practice = answered(1, 1);
  practice.type = TrialType::practice;
  trials.insert(trials.end(), {timeout, practice});
  const auto all = confusions(trials, {}, 3);
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].rows.size() == 2);
  CHECK(all[0].rows[0].answers == std::vector<int>{15, 3, 2});
  CHECK(all[0].rows[1].answers == std::vector<int>{0, 0, 4});
  CHECK(all[0].rows[0].right->interval.low == Approx(0.508954).margin(1e-6));  // from R: binom.test(15, 20)
  CHECK(all[0].rows[0].right->interval.high == Approx(0.913429).margin(1e-6));
  CHECK(all[0].rows[1].right->interval.high == 1);
  CHECK(all[0].right->right == 19);
  CHECK(all[0].right->trials == 24);
}

TEST_CASE("without right answers the rows of a confusion matrix are levels, and conditions are kept apart",
          "[analysis]") {
  std::vector<TrialRecord> trials{answered({}, 2, 5.0), answered({}, 0, -1.0), answered({}, 1, 5.0)};
  trials[1].instruction = "other";
  const auto all = confusions(trials, {"other"}, 3);
  REQUIRE(all.size() == 2);
  CHECK(all[0].condition == "other");
  CHECK(all[0].rows.at(0).level == -1.0);
  CHECK(all[1].rows.at(0).answers == std::vector<int>{0, 1, 1});
  CHECK_FALSE(all[1].rows.at(0).right);
  CHECK_FALSE(all[1].right);
}
