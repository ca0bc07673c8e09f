#include <cmath>

#include "station/analysis/proportion.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/core/draws.hpp"
#include "station/simulation/observer.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

TEST_CASE("Wilson and Clopper-Pearson intervals of 15 out of 20 equal the published ones", "[analysis]") {
  const auto score = wilson(15, 20);
  CHECK(score.low == Approx(0.531299).margin(5e-7));
  CHECK(score.high == Approx(0.888138).margin(5e-7));
  const auto exact = clopper_pearson(15, 20);
  CHECK(exact.low == Approx(0.508954).margin(5e-7));
  CHECK(exact.high == Approx(0.913429).margin(5e-7));
}

TEST_CASE("Intervals of a proportion stay inside 0 to 1 and mirror each other", "[analysis]") {
  for (const int n : {1, 2, 7, 400})
    for (int k = 0; k <= n; ++k)
      for (const auto make : {wilson, clopper_pearson}) {
        const auto interval = make(k, n, 0.95), mirrored = make(n - k, n, 0.95);
        CHECK(interval.low >= 0);
        CHECK(interval.high <= 1);
        CHECK(interval.low <= double(k) / n);
        CHECK(interval.high >= double(k) / n);
        CHECK(interval.low == Approx(1 - mirrored.high).margin(1e-12));
      }
  CHECK(clopper_pearson(0, 10).high == Approx(1 - std::pow(0.025, 0.1)).epsilon(1e-12));
  CHECK_THROWS_AS(wilson(3, 2), std::invalid_argument);
  CHECK_THROWS_AS(clopper_pearson(0, 0), std::invalid_argument);
}

TEST_CASE(
    "Clopper-Pearson intervals contain the true value at least as often as they claim, but plain normal "
    "intervals do not",
    "[analysis]") {
  const auto covered = [](double p, int n, auto interval) {
    double sum = 0, mass = std::pow(1 - p, n);
    for (int k = 0; k <= n; ++k) {
      const auto i = interval(k, n);
      if (i.low <= p && p <= i.high) sum += mass;
      mass *= (n - k) / (k + 1.0) * p / (1 - p);
    }
    return sum;
  };
  const auto exact = [](int k, int n) { return clopper_pearson(k, n); };
  const auto normal = [](int k, int n) {
    const double p = double(k) / n, half = 1.96 * std::sqrt(p * (1 - p) / n);
    return Interval{p - half, p + half, 0.95};
  };
  for (const double p : {0.02, 0.3, 0.5, 0.93}) CHECK(covered(p, 24, exact) >= 0.95);
  CHECK(covered(0.02, 24, normal) < 0.5);
}

TEST_CASE("Yes/no sensitivity with the log-linear correction is finite for perfect rates", "[analysis]") {
  const auto perfect = yes_no({20, 0, 0, 20});
  REQUIRE(perfect);
  CHECK(perfect->hit_rate == Approx(20.5 / 21));
  CHECK(perfect->d_prime == Approx(2 * normal_quantile(20.5 / 21)));
  CHECK(perfect->criterion == 0);  // not the round-off of z(p) + z(1 - p)
  const auto shy = yes_no({5, 15, 1, 19});
  CHECK(shy->criterion > 0.5);
  CHECK_FALSE(yes_no({0, 0, 3, 4}).has_value());
}

TEST_CASE("The normal quantile is the inverse of the distribution function", "[analysis]") {
  for (const double z : {-6.0, -2.0, -0.1, 0.0, 1.0, 5.0})
    CHECK(normal_quantile(normal_cdf(z)) == Approx(z).margin(1e-9));
  CHECK_THROWS_AS(normal_quantile(0), std::invalid_argument);
}

namespace {

/// Makes a session of a simulated observer who answers yes or no or, if there are more than two answers,
/// gives ratings. Half of the trials have no signal.
std::vector<TrialRecord> yes_no_session(const turnpoint::simulation::Observer& observer, int answers,
                                        int trials, int run) {
  using namespace turnpoint;
  std::vector<TrialRecord> session;
  for (int i = 0; i < trials; ++i) {
    simulation::Question question;
    question.decides = simulation::Decides::presence;
    question.rating = answers > 2;
    question.answers = answers;
    question.level = i % 2 == 0 ? 0 : i % 4 == 1 ? 3 : 6;
    question.key = {9, core::Stream::observer, run, 0, i};
    TrialRecord trial;
    trial.level = question.level;
    trial.right_choice = question.level > 0;
    trial.response = observer.answer(question).choice;
    session.push_back(trial);
  }
  return session;
}

bool holds(const std::optional<Estimate>& estimate, double value) {
  return estimate && estimate->interval.low <= value && value <= estimate->interval.high;
}

}  // namespace

TEST_CASE("The intervals of d' and criterion contain the true values of a yes/no observer", "[analysis]") {
  // d' is 1.349 at level 3 and twice that at level 6; c is the criterion minus half of d'.
  const turnpoint::simulation::Observer observer(
      turnpoint::simulation::parse("sim:threshold=3,lapse=0,criterion=0.9"));
  const int sessions = 400;
  int weak = 0, strong = 0, criterion = 0;
  double sum = 0;
  for (int run = 0; run < sessions; ++run) {
    const auto found = detect(yes_no_session(observer, 2, 400, run), {}, Detecting::presence, 1);
    REQUIRE(found.size() == 3);
    CHECK(*found[0].level == 3);
    CHECK(found[0].counts.false_alarms + found[0].counts.correct_rejections == 200);
    CHECK_FALSE(found[2].level);
    weak += holds(found[0].d_prime, 1.34898);
    strong += holds(found[1].d_prime, 2.69796);
    criterion += holds(found[0].criterion, 0.9 - 1.34898 / 2);
    sum += found[0].d_prime->value;
  }
  INFO("of " << sessions << ": " << weak << ", " << strong << ", " << criterion);
  for (const int count : {weak, strong, criterion}) {
    CHECK(count >= 0.92 * sessions);
    CHECK(count < sessions);
  }
  CHECK(sum / sessions == Approx(1.349).margin(0.03));
}

TEST_CASE("d' for left/right answers and for forced choice follows its definition", "[analysis]") {
  std::vector<TrialRecord> trials;
  const auto add = [&trials](double level, int right, int response, int times) {
    for (int i = 0; i < times; ++i) {
      TrialRecord trial;
      trial.level = level, trial.right_choice = right, trial.response = response;
      trials.push_back(trial);
    }
  };
  add(5, 1, 1, 80), add(5, 1, 0, 20), add(-5, 0, 1, 40), add(-5, 0, 0, 60);
  const auto sides = detect(trials, {}, Detecting::sides, 1);
  REQUIRE(sides.size() == 2);
  CHECK(*sides[0].level == 5);
  const auto direct = *yes_no({80, 20, 40, 60});
  CHECK(sides[0].d_prime->value == direct.d_prime);
  CHECK(sides[0].criterion->value == direct.criterion);
  for (auto& trial : trials) trial.level = -12;
  const auto forced = detect(trials, {}, Detecting::forced_choice, 1);
  CHECK(*forced[0].level == -12);
  CHECK(forced[0].d_prime->value == Approx(direct.d_prime / std::sqrt(2.0)));
  trials.resize(100);  // only trials with a signal are left, so there is no d'
  CHECK_FALSE(detect(trials, {}, Detecting::forced_choice, 1)[0].d_prime);
}

TEST_CASE(
    "The area under the ROC of ratings is the one that follows from d', and its interval contains this area",
    "[analysis]") {
  const auto example = roc({30, 15, 5}, {5, 15, 30});
  REQUIRE(example);
  REQUIRE(example->points.size() == 4);
  CHECK(example->points[1].hits == Approx(0.6));
  CHECK(example->points[1].false_alarms == Approx(0.1));
  // The expected area, counted by hand as Mann and Whitney count pairs: (30 (15 + 30 + 5/2) + 15 (30 + 15/2)
  // + 5 (30/2)) / 2500.
  CHECK(example->area.value == Approx((30 * 47.5 + 15 * 37.5 + 5 * 15) / 2500.0));
  const turnpoint::simulation::Observer observer(turnpoint::simulation::parse("sim:threshold=3,lapse=0"));
  int held = 0;
  const int sessions = 200;
  // `expected` is the area under the observer's true ROC with six ratings
  double expected = 0, below = 0;
  turnpoint::simulation::Question question;
  question.decides = turnpoint::simulation::Decides::presence, question.rating = true, question.answers = 6;
  for (int rating = 0; rating < 6; ++rating) {
    question.level = 0;
    const double noise = observer.share(question, rating);
    question.level = 3;
    expected += observer.share(question, rating) * (below + noise / 2), below += noise;
  }
  for (int run = 0; run < sessions; ++run) {
    std::vector<int> noise(6), signal(6);
    for (const auto& trial : yes_no_session(observer, 6, 400, run))
      if (*trial.level != 6)
        ++(*trial.level == 0 ? noise : signal)[static_cast<std::size_t>(*trial.response)];
    held += holds(roc(noise, signal)->area, expected);
  }
  CHECK(held >= 0.91 * sessions);
  CHECK(held < sessions);
  CHECK_FALSE(roc({0, 0}, {1, 2}));
  CHECK_THROWS_AS(roc({1}, {1}), std::invalid_argument);
  CHECK_THROWS_AS(roc({1, 2}, {1, -2}), std::invalid_argument);
}

TEST_CASE("the interval of the area under a ROC holds with few trials and strong signals, too",
          "[analysis]") {
  const auto certain = roc({20, 0}, {0, 20})->area;
  CHECK(certain.value == 1);
  CHECK(certain.interval.high == 1);
  CHECK(certain.interval.low == Approx(0.898668).epsilon(1e-5));
  CHECK(roc({0, 20}, {20, 0})->area.interval.high == Approx(1 - certain.interval.low));
  turnpoint::core::Draws draws({4, turnpoint::core::Stream::observer, 0, 0, 0});
  for (const double mean : {0.5, 3.0}) {
    INFO(mean);
    const auto rating = [&](double at) {
      std::size_t above = 0;
      for (int k = 0; k < 5; ++k) above += at > -0.5 + k * (mean + 1) / 4 ? 1 : 0;
      return above;
    };
    double area = 0, below = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto share = [&](double centre) {
        const auto edge = [&](std::size_t i) {
          return normal_cdf(-0.5 + (double(i) - 1) * (mean + 1) / 4 - centre);
        };
        return (k == 5 ? 1 : edge(k + 1)) - (k == 0 ? 0 : edge(k));
      };
      area += share(mean) * (below + share(0) / 2), below += share(0);
    }
    int held = 0;
    const int sessions = 1000;
    for (int session = 0; session < sessions; ++session) {
      std::vector<int> noise(6), signal(6);
      for (int trial = 0; trial < 10; ++trial) ++noise[rating(normal_quantile(draws.uniform()))];
      for (int trial = 0; trial < 30; ++trial) ++signal[rating(mean + normal_quantile(draws.uniform()))];
      held += holds(roc(noise, signal)->area, area);
    }
    // The interval of Hanley and McNeil holds in 91 % of such sessions with a mean of 0.5, and in 81 %
    // with 3.
    CHECK(held > 0.935 * sessions);
  }
}

TEST_CASE("Answers with confidence are the ratings of a ROC, and all levels share the noise", "[analysis]") {
  std::vector<TrialRecord> trials;
  const auto add = [&](double level, bool yes, int confidence, int count) {
    TrialRecord trial;
    trial.level = level, trial.right_choice = level > 0, trial.response = yes, trial.confidence = confidence;
    trials.insert(trials.end(), static_cast<std::size_t>(count), trial);
  };
  // from the surest no to the surest yes: noise 6 2 1 1, level 1: 1 2 2 5, level 2: 0 0 0 10
  add(0, false, 2, 6), add(0, false, 1, 2), add(0, true, 1, 1), add(0, true, 2, 1);
  add(1, false, 2, 1), add(1, false, 1, 2), add(1, true, 1, 2), add(1, true, 2, 5), add(2, true, 2, 10);
  auto without = trials.front();
  without.confidence.reset();
  trials.push_back(without);  // a trial without confidence is left out
  const auto curves = rocs(trials, {}, 1);
  REQUIRE(curves.size() == 3);
  CHECK(curves[0].noise == std::vector<int>{6, 2, 1, 1});
  CHECK(curves[0].signal == std::vector<int>{1, 2, 2, 5});
  CHECK(curves[0].roc.area.value == roc({6, 2, 1, 1}, {1, 2, 2, 5})->area.value);
  CHECK(curves[1].level == 2.0);
  CHECK(curves[1].roc.area.value == roc({6, 2, 1, 1}, {0, 0, 0, 10})->area.value);
  CHECK_FALSE(curves[2].level);
  CHECK(curves[2].signal == std::vector<int>{1, 2, 2, 15});
  CHECK(rocs(trials, {}, 1, 1).size() == 1);  // too many levels: only all of them together
  std::erase_if(trials, [](const auto& trial) { return *trial.level == 0; });
  CHECK(rocs(trials, {}, 1).empty());  // without noise there is no curve
}
