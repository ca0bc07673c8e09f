#include "station/simulation/observer.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "station/analysis/diffusion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/core/elementary.hpp"
#include "station/core/usage_error.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::simulation;

namespace {

Question at_level(double level) {
  Question question;
  question.level = level;
  question.correct = 0;
  return question;
}

/// Returns the share of each answer in this many simulated trials.
std::vector<double> shares(const Observer& observer, Question question, int trials) {
  std::vector<double> counts(static_cast<std::size_t>(question.answers));
  for (int trial = 0; trial < trials; ++trial) {
    question.key.trial = trial;
    counts[static_cast<std::size_t>(*observer.answer(question).choice)] += 1.0 / trials;
  }
  return counts;
}

void check_shares(const Observer& observer, const Question& question) {
  const int n = 40'000;
  const auto found = shares(observer, question, n);
  double sum = 0;
  for (int choice = 0; choice < question.answers; ++choice) {
    const double p = observer.share(question, choice);
    sum += p;
    INFO("choice " << choice << " at level " << question.level);
    CHECK(found[static_cast<std::size_t>(choice)] == Approx(p).margin(4.5 * std::sqrt(p * (1 - p) / n)));
  }
  CHECK(sum == Approx(1));
}

}  // namespace

TEST_CASE("EZ-diffusion finds the drift, boundary and residual time of the observer", "[observer]") {
  // Expected for the normalised bound A' = .85 and the proportion correct Pc: boundary a = 0.2 A' = .17,
  // non-decision time Ter = .35 s residual + .15 s travel time, drift v = .1 logit(Pc) / (2 A'). Each
  // proportion gets 100 fits of 10 000 trials.
  const Observer observer(parse("sim:threshold=1,lapse=0"));
  const int fits = 100, trials = 10'000;
  for (const double proportion : {0.8, 0.9, 0.97}) {
    auto question = at_level(std::log2(0.5 / (1 - proportion)));
    std::vector<double> drift, boundary, nondecision;
    for (int fit = 0; fit < fits; ++fit) {
      std::vector<double> times;
      for (int trial = 0; trial < trials; ++trial) {
        question.key = {1, core::Stream::observer, fit, 0, trial};
        const auto reply = observer.answer(question);
        if (reply.choice == 0) times.push_back(reply.response_time_s);
      }
      const auto ez = analysis::ez_diffusion(static_cast<double>(times.size()) / trials, trials,
                                             analysis::mean(times), analysis::variance(times));
      REQUIRE(ez);
      drift.push_back(ez->drift);
      boundary.push_back(ez->boundary);
      nondecision.push_back(ez->nondecision_s);
    }
    INFO("proportion correct " << proportion);
    const double v = 0.1 * std::log(proportion / (1 - proportion)) / (2 * 0.85);
    CHECK(analysis::mean(drift) == Approx(v).epsilon(0.01));
    CHECK(analysis::mean(boundary) == Approx(0.17).epsilon(0.01));
    CHECK(analysis::mean(nondecision) == Approx(0.50).epsilon(0.01));
  }
}

TEST_CASE("an observer gives each answer with the stated probability", "[observer]") {
  for (const auto* text :
       {"sim:threshold=4,lapse=0.05", "sim:threshold=4,slope=2,drift_sd=0.6,start_range=0.5"}) {
    INFO(text);
    const Observer observer(parse(text));
    for (const double level : {0.0, 2.0, 4.0, 9.0}) {
      auto question = at_level(level);
      check_shares(observer, question);
      question.answers = 3;
      check_shares(observer, question);
      question.deadline_s = 0.9;
      check_shares(observer, question);
      question.answers = 2, question.decides = Decides::side, question.level = -level;
      check_shares(observer, question);
      question.decides = Decides::presence, question.level = level;
      check_shares(observer, question);
    }
  }
}

TEST_CASE("at its threshold an observer is right 75 % of the time, whatever is asked", "[observer]") {
  const Observer observer(parse("sim:threshold=6,lapse=0"));
  auto question = at_level(6);
  CHECK(observer.share(question, 0) == Approx(0.75));
  question.decides = Decides::side;
  CHECK(observer.share(question, question.positive) == Approx(0.75));
  question.decides = Decides::presence;
  CHECK(observer.share(question, question.positive) == Approx(0.75));
  question.level = 0;
  CHECK(observer.share(question, question.positive) == Approx(0.25));
  question = at_level(-20), question.decibel = true;
  CHECK(Observer(parse("sim:threshold=-20,lapse=0")).share(question, 0) == Approx(0.75));
}

TEST_CASE("if one answer is right, answers follow a Weibull function with the observer's slope",
          "[observer]") {
  const Observer observer(parse("sim:threshold=3,slope=1.7,lapse=0.04"));
  for (const double level : {0.5, 2.0, 3.0, 5.0})
    for (const int answers : {2, 3}) {
      auto question = at_level(level);
      question.answers = answers;
      const double guess = 1.0 / answers, core = 1 - std::exp2(-std::pow(level / 3, 1.7));
      CHECK(observer.share(question, 0) == Approx(0.96 * (guess + (1 - guess) * core) + 0.04 * guess));
    }
}

TEST_CASE("if the answers are two sides, they follow a normal distribution around the bias", "[observer]") {
  const Observer observer(parse("sim:threshold=4,lapse=0,bias=3"));
  auto question = at_level(0);
  question.decides = Decides::side, question.positive = 0;
  for (const double level : {-5.0, 0.0, 3.0, 4.0, 11.0}) {
    question.level = level;
    const double z = (level - 3) / 4 * 0.6744897501960817;
    CHECK(observer.share(question, 0) == Approx(0.5 * std::erfc(-z / std::sqrt(2.0))).epsilon(1e-9));
  }
}

TEST_CASE("compared stimuli have places on the observer's own scale, which bends with its slope",
          "[observer]") {
  const auto share = [](const std::string& observer, std::vector<double> places) {
    simulation::Question question;
    question.decides = simulation::Decides::side, question.positive = 1;
    question.compared = std::move(places), question.range = 20;
    return simulation::Observer(simulation::parse(observer)).share(question, 1);
  };
  // A difference of the threshold, 5 of 20, is found in 75 % of the trials, on a straight and a bent scale.
  CHECK(share("sim:threshold=5,lapse=0", {0.5, 0.75}) == Approx(0.75));
  CHECK(share("sim:threshold=5,lapse=0,slope=2", {0.5, std::sqrt(0.5)}) == Approx(0.75));
  CHECK(share("sim:threshold=5,lapse=0,slope=2", {0, 0.5, 1}) == Approx(core::normal_cdf(2 * 0.6744898)));
  CHECK(share("sim:threshold=5,lapse=0,slope=2", {1, 0.5, 0}) == Approx(1 - core::normal_cdf(2 * 0.6744898)));
  CHECK(share("sim:threshold=5,lapse=0", {0.1, 0.2, 0.8, 0.9}) == Approx(0.5));
}

TEST_CASE("yes and no are separated by the criterion", "[observer]") {
  auto question = at_level(6);
  question.decides = Decides::presence;
  for (const double criterion : {-0.5, 0.2, 1.5}) {
    const Observer observer(parse("sim:threshold=3,lapse=0,criterion=" + std::to_string(criterion)));
    // The inverse of the normal distribution function, found by bisection. The distribution is computed here
    // without the program's code.
    const auto z = [&](double p) {
      double low = -9, high = 9;
      for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
      }
      return low;
    };
    question.absent = true;
    const double false_alarms = observer.share(question, 1);
    question.absent = false;
    const double hits = observer.share(question, 1);
    CHECK(z(false_alarms) == Approx(-criterion).margin(1e-7));
    CHECK(z(hits) - z(false_alarms) == Approx(2 * 2 * 0.6744897501960817).margin(1e-6));
  }
}

TEST_CASE("ratings of signal and noise overlap as d' predicts", "[observer]") {
  const Observer observer(parse("sim:threshold=5,lapse=0"));
  auto question = at_level(5);
  question.decides = Decides::presence, question.answers = 6, question.rating = true;
  check_shares(observer, question);
  double area = 0, below = 0;
  for (int rating = 0; rating < 6; ++rating) {
    question.absent = true;
    const double noise = observer.share(question, rating);
    question.absent = false;
    const double signal = observer.share(question, rating);
    area += signal * (below + 0.5 * noise), below += noise;
  }
  // Phi(d' / sqrt 2) is the area under the continuous ROC; with only six ratings the area is smaller.
  const double whole = 0.5 * std::erfc(-1.349 / 2);
  CHECK(area < whole);
  CHECK(area > whole - 0.02);
}

TEST_CASE(
    "confidence rests on the same evidence as the answer, so that the least sure are right by chance or more",
    "[observer]") {
  const Observer observer(parse("sim:threshold=1,lapse=0"));
  auto question = at_level(1);
  question.confidence = 4;
  std::vector<int> right(5), all(5);
  for (int trial = 0; trial < 20'000; ++trial) {
    question.key.trial = trial;
    const auto reply = observer.answer(question);
    const auto degree = static_cast<std::size_t>(*reply.confidence);
    ++all[degree], right[degree] += *reply.choice == 0;
  }
  // The evidence has mean z(.75) = .674 and SD 1. Answers are right if it is positive; degrees are .5 apart.
  // For example, the least sure have evidence between -.5 and .5, and between 0 and .5 if they are right.
  const double expected[]{0.582, 0.729, 0.839, 0.932};
  for (std::size_t degree = 1; degree <= 4; ++degree)
    CHECK(static_cast<double>(right[degree]) / all[degree] == Approx(expected[degree - 1]).margin(0.03));
}

TEST_CASE("a deadline lowers the bound so that few decisions come too late", "[observer]") {
  const Observer observer(parse("sim:threshold=1,lapse=0"));
  auto question = at_level(0);
  question.deadline_s = 0.8;
  int late = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    question.key.trial = trial;
    late += observer.answer(question).response_time_s > 0.8;
  }
  CHECK(late < 0.045 * 20'000);
  CHECK(late > 0.01 * 20'000);
  auto easy = at_level(1);
  const double careful = observer.share(easy, 0);
  easy.deadline_s = 0.8;
  CHECK(observer.share(easy, 0) < careful - 0.05);
}

TEST_CASE("non-decision times vary within their range", "[observer]") {
  // At 100 times the threshold, a decision takes a few hundredths of a second.
  const Observer observer(parse("sim:threshold=1,slope=4,bound=0.01,residual=0.5,residual_range=0.4"));
  auto question = at_level(100);
  std::vector<double> times;
  for (int trial = 0; trial < 20'000; ++trial) {
    question.key.trial = trial;
    times.push_back(observer.answer(question).response_time_s);
  }
  CHECK(analysis::mean(times) == Approx(0.65).margin(4 * 0.4 / std::sqrt(12.0 * 20'000) + 1e-4));
  CHECK(analysis::variance(times) == Approx(0.16 / 12).epsilon(0.05));
}

TEST_CASE("a description of an observer that is not understood is refused, with what is allowed",
          "[observer]") {
  for (const auto* text :
       {"human", "sim:treshold=3", "sim:threshold=x", "sim:lapse=2", "sim:threshold=0", "sim:slope",
        "sim:spread=0.25", "sim:start_range=1", "sim:drift_sd=-1", "sim:residual=0.1,residual_range=0.3"})
    CHECK_THROWS_AS(parse(text), core::UsageError);
  CHECK(parse("sim").lapse == 0.02);
  CHECK(parse("sim:criterion=-0.3,drift_sd=0.2").criterion == -0.3);
}

TEST_CASE(
    "an observer of categories confuses neighbours as a normal distribution with criteria halfway predicts",
    "[observer]") {
  Question question;
  question.decides = Decides::category;
  question.categories = {30, 10, 20, 60};
  question.answers = 4;
  question.default_threshold = 10;
  const Observer observer(parse("sim:lapse=0"));
  // Two categories that differ by the threshold of 10 are told apart in 75 % of trials. The border is 5 from
  // each, and z(0.75) = 0.67449, so the SD of the noise is 5 / 0.67449 = 7.41301.
  const auto below = [](double x, double level) {
    return 0.5 * std::erfc((level - x) / 7.41301 / std::sqrt(2.0));
  };
  for (const double level : {10.0, 20.0, 33.0, 60.0}) {
    question.level = level;
    CHECK(observer.share(question, 1) == Approx(below(15, level)).margin(1e-6));
    CHECK(observer.share(question, 2) == Approx(below(25, level) - below(15, level)).margin(1e-6));
    CHECK(observer.share(question, 0) == Approx(below(45, level) - below(25, level)).margin(1e-6));
    CHECK(observer.share(question, 3) == Approx(1 - below(45, level)).margin(1e-6));
    check_shares(observer, question);
    check_shares(Observer(parse("sim:lapse=0.1,threshold=4")), question);
  }
}

TEST_CASE("with several intervals, and in ABX, the observer is as good as its noisy observations are",
          "[observer]") {
  // `low` becomes the d' of an observer who is right in 1 - 2^-(1 + level) of the trials with two intervals.
  // Noisy observations with this d' are simulated in the other tasks, and their proportions of right answers
  // are compared with the observer's.
  std::mt19937_64 random(7);
  std::normal_distribution<> noise;
  constexpr int trials = 200'000;
  const Observer observer(parse("sim:threshold=1,lapse=0"));
  for (const double level : {0.4, 1.0, 2.0}) {
    auto question = at_level(level);
    double low = 0, high = 10;
    for (int i = 0; i < 50; ++i) {
      const double d = 0.5 * (low + high);
      (0.5 * std::erfc(-d / 2) < 1 - std::pow(2, -1 - level) ? low : high) = d;
    }
    int of_three = 0, of_four = 0, abx = 0;
    for (int i = 0; i < trials; ++i) {
      const double signal = low + noise(random), others = std::max(noise(random), noise(random));
      of_three += signal > others;
      of_four += signal > std::max(others, noise(random));
      const double x = noise(random), a = noise(random), b = low + noise(random);
      abx += std::fabs(x - a) < std::fabs(x - b);
    }
    const auto check = [&](Finding finding, int answers, int right) {
      question.finding = finding, question.answers = answers;
      const double p = static_cast<double>(right) / trials;
      INFO(answers << " answers at level " << level);
      CHECK(observer.share(question, 0) == Approx(p).margin(4 * std::sqrt(p * (1 - p) / trials)));
      check_shares(observer, question);
      check_shares(Observer(parse("sim:lapse=0.1,threshold=1,start_range=0.3")), question);
    };
    check(Finding::largest, 3, of_three);
    check(Finding::largest, 4, of_four);
    check(Finding::nearest, 2, abx);
  }
}

TEST_CASE("at a response signal the observer answers from what it has found out so far", "[observer]") {
  const Observer observer(
      parse("sim:threshold=1,lapse=0,anticipation=0,residual=0.2,residual_range=0.1,travel=0"));
  auto question = at_level(1.5);
  double last = 0.45;
  for (const double signal_s : {0.05, 0.3, 1.0, 3.0}) {
    CAPTURE(signal_s);
    question.signal_s = signal_s;
    int right = 0;
    constexpr int n = 20'000;
    for (int trial = 0; trial < n; ++trial) {
      question.key.trial = trial;
      const auto reply = observer.answer(question);
      right += reply.choice == 0;
      CHECK(reply.response_time_s >= signal_s + 0.05);
      CHECK(reply.response_time_s <= signal_s + 0.15);
    }
    const double share = observer.share(question, 0);
    CHECK(right / static_cast<double>(n) == Approx(share).margin(4 * std::sqrt(0.25 / n)));
    CHECK(share > last);
    last = share;
  }
  question.signal_s.reset();
  CHECK(last == Approx(observer.share(question, 0)).margin(0.01));
}

TEST_CASE("the threshold moves along the second dimension by the gradient, and not below the floor",
          "[observer]") {
  const Observer observer(parse("sim:threshold=-16,gradient=0.2,floor=-18,lapse=0"));
  const auto right = [&](double level, double second) {
    auto question = at_level(level);
    question.decibel = true, question.second = second;
    return observer.share(question, 0);
  };
  CHECK(right(-16, 0) == Approx(0.75));
  CHECK(right(-12, 20) == Approx(0.75));
  CHECK(right(-17, -5) == Approx(0.75));
  CHECK(right(-18, -40) == Approx(0.75));  // without the floor, the threshold would be -24 dB
  CHECK(right(-16, 20) < 0.7);
  const Observer ratios(parse("sim:threshold=0.1,gradient=0.02,lapse=0,criterion=0"));
  auto question = at_level(0.1 * std::pow(10, 0.4));
  question.decides = Decides::presence, question.second = 20, question.log_step = std::log(10.0);
  CHECK(ratios.share(question, 1) == Approx(core::normal_cdf(1.3489795)).epsilon(1e-6));
  question.log_step = std::log(10.0) / 20, question.level = 0.1 * std::pow(10, 0.02);
  CHECK(ratios.share(question, 1) == Approx(core::normal_cdf(1.3489795)).epsilon(1e-6));
  question.decides = Decides::side, question.log_step = 0, question.level = 0.4;
  const Observer sides(parse("sim:threshold=0.1,gradient=0.02,lapse=0"));
  CHECK(sides.share(question, 1) == Approx(0.5));
}
