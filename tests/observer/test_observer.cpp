#include <cmath>

#include "station/observer/observer.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::observer;

TEST_CASE("accuracy and response time follow Palmer, Huk and Shadlen", "[observer]") {
  // A' = .85, k = 9, tR = .35 at x = .1 (their proportional-rate model).
  CHECK(accuracy(0.85, 0.9) == Approx(0.82201).margin(1e-5));
  CHECK(mean_decision_s(0.85, 0.9) + 0.35 == Approx(0.95823).margin(1e-5));
  CHECK(mean_decision_s(0.85, 0) == Approx(0.85 * 0.85));
  CHECK(accuracy(0.85, 0) == 0.5);
}

TEST_CASE("a simulated observer is right 75 % of the time at its threshold", "[observer]") {
  auto parameters = parse("sim:threshold=6,lapse=0");
  const Observer observer(parameters);
  int right = 0;
  const int n = 20'000;
  for (int trial = 0; trial < n; ++trial) {
    Question question;
    question.level = 6;
    question.correct = trial % 2;
    question.key.seed = 1;
    question.key.trial = trial;
    right += observer.answer(question).choice == trial % 2 ? 1 : 0;
  }
  CHECK(right / static_cast<double>(n) == Approx(0.75).margin(5 * std::sqrt(0.75 * 0.25 / n)));
}

TEST_CASE("a biased observer is balanced at its bias", "[observer]") {
  const Observer observer(parse("sim:threshold=4,lapse=0,bias=3"));
  int positive = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Question question;
    question.level = 3;
    question.signed_level = true;
    question.key.trial = trial;
    positive += observer.answer(question).choice == 1 ? 1 : 0;
  }
  CHECK(positive == Approx(2000).margin(160));
}

TEST_CASE("an observer that is not understood is refused with what is allowed", "[observer]") {
  for (const auto* text :
       {"human", "sim:treshold=3", "sim:threshold=x", "sim:lapse=2", "sim:threshold=0", "sim:slope"})
    CHECK_THROWS_AS(parse(text), std::invalid_argument);
  CHECK(parse("sim").lapse == 0.02);
}
