#include "station/analysis/settings.hpp"
#include "station/analysis/student.hpp"
#include "station/core/draws.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

analysis::TrialRecord set_to(double value, double start = 0) {
  analysis::TrialRecord trial;
  trial.procedure = "match";
  trial.level = start;
  trial.setting = value;
  return trial;
}

}  // namespace

TEST_CASE("Settings get their mean and scatter with intervals by Student's t and chi squared", "[analysis]") {
  // From tables: the 97.5 % point of t(7) is 2.364624; the 97.5 % and 2.5 % points of chi2(7) are 16.012764
  // and 1.689869.
  const std::vector<double> values{2, 4, 4, 4, 5, 5, 7, 9};
  std::vector<analysis::TrialRecord> trials;
  for (const double v : values) trials.push_back(set_to(v));
  const auto all = analysis::settings(trials);
  REQUIRE(all.size() == 1);
  const double sd = std::sqrt(32.0 / 7);
  REQUIRE(all[0].mean);
  CHECK(all[0].mean->value == Approx(5));
  CHECK(all[0].mean->interval.high == Approx(5 + 2.364624 * sd / std::sqrt(8.0)).epsilon(1e-6));
  REQUIRE(all[0].sd);
  CHECK(all[0].sd->value == Approx(sd));
  CHECK(all[0].sd->interval.low == Approx(std::sqrt(32 / 16.012764)).epsilon(1e-6));
  CHECK(all[0].sd->interval.high == Approx(std::sqrt(32 / 1.689869)).epsilon(1e-6));
  CHECK_FALSE(all[0].start_slope);  // no slope, because the slider always started at the same position
}

TEST_CASE("Settings that depend on the slider's start position are reported as such", "[analysis]") {
  std::vector<analysis::TrialRecord> pulled, free;
  for (int i = 0; i < 24; ++i) {
    const double start = i % 2 ? 20 : -20, scatter = 3 * std::sin(1.7 * i);
    pulled.push_back(set_to(0.3 * start + scatter, start));
    free.push_back(set_to(scatter, start));
  }
  const auto follows = analysis::settings(pulled).front();
  REQUIRE(follows.start_slope);
  CHECK(follows.start_slope->interval.low < 0.3);
  CHECK(follows.start_slope->interval.high > 0.3);
  REQUIRE(follows.statements.size() == 1);
  CHECK(follows.statements[0].code == "follows-start");
  CHECK(analysis::settings(free).front().statements.empty());
}

TEST_CASE("Too few settings, equal settings and void trials give statements instead of numbers",
          "[analysis]") {
  auto timeout = set_to(9);
  timeout.outcome = core::Outcome::timeout;
  auto practice = set_to(9);
  practice.type = core::TrialType::practice;
  const auto two = analysis::settings({set_to(1), set_to(2), timeout, practice}).front();
  CHECK(two.values.size() == 2);
  CHECK_FALSE(two.mean);
  CHECK(two.statements.at(0).code == "few-settings");
  const auto equal = analysis::settings({set_to(3), set_to(3), set_to(3)}).front();
  CHECK(equal.mean->value == 3);
  CHECK_FALSE(equal.sd);
  CHECK(equal.statements.at(0).code == "equal-settings");
  CHECK(analysis::settings({timeout}).empty());
}

TEST_CASE("Settings by the side of the start: means, scatters, and the difference by Welch's t",
          "[analysis]") {
  // Expected values by hand after Welch (1947): the two means have the variances 2.5 / 5 and 10 / 5, so their
  // difference has the standard error sqrt(2.5). The degrees of freedom are 2.5^2 / (0.5^2 / 4 + 2^2 / 4) =
  // 5.882353, for which t(.975) = 2.458824 (integrated by Simpson's rule).
  std::vector<analysis::TrialRecord> trials;
  for (const double v : {1, 2, 3, 4, 5}) {
    trials.push_back(set_to(v, -20)), trials.back().start_side = analysis::StartSide::below;
    trials.push_back(set_to(2 * v, 20)), trials.back().start_side = analysis::StartSide::above;
  }
  trials.push_back(set_to(100, 0));  // this start is neither below nor above
  const auto s = analysis::settings(trials).front();
  CHECK(s.values.size() == 11);
  CHECK(s.from_below.settings == 5);
  CHECK(s.from_above.settings == 5);
  CHECK(s.from_below.mean->value == 3);
  CHECK(s.from_above.mean->value == 6);
  CHECK(s.from_below.sd->value == Approx(std::sqrt(2.5)));
  CHECK(s.from_above.sd->value == Approx(std::sqrt(10.0)));
  CHECK(s.side_difference->value == -3);
  CHECK(s.side_difference->interval.high == Approx(-3 + 2.458824 * std::sqrt(2.5)).epsilon(1e-6));
  const auto none = analysis::settings({set_to(1), set_to(2), set_to(4)}).front();
  CHECK(none.from_below.settings == 0);
  CHECK_FALSE(none.side_difference);
}

TEST_CASE("The interval of a ratio covers the ratio of the means", "[analysis]") {
  // points in times that depend on the answer, as in blocks of a fixed time with a delay after errors
  int covered = 0;
  const int runs = 1500;
  for (int run = 0; run < runs; ++run) {
    core::Draws draws({17, core::Stream::observer, run, 0, 0});
    std::vector<double> points, minutes;
    for (int i = 0; i < 60; ++i) {
      const bool right = draws.uniform() < 0.8;
      points.push_back(right ? 1 : 0);
      minutes.push_back(0.05 + 0.02 * draws.uniform() + (right ? 0 : 0.025));
    }
    const auto rate = analysis::student_ratio(points, minutes);
    REQUIRE(rate);
    const double truth = 0.8 / (0.06 + 0.2 * 0.025);
    covered += rate->interval.low <= truth && truth <= rate->interval.high ? 1 : 0;
  }
  INFO("covered in " << covered << " of " << runs);
  CHECK(covered > 0.93 * runs);
  CHECK(covered < 0.97 * runs);
  CHECK(analysis::student_ratio({1, 1, 1}, {2, 2, 2})->interval.low == 0.5);
  CHECK_FALSE(analysis::student_ratio({1, 0}, {2, 2}));
  // with equal times it is Student's interval of the mean
  const auto ratio = analysis::student_ratio({3, 5, 10}, {1, 1, 1}),
             mean = analysis::student_mean({3, 5, 10});
  CHECK(ratio->value == Approx(mean->value));
  CHECK(ratio->interval.high == Approx(mean->interval.high));
}
