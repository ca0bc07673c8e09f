#include "station/analysis/group.hpp"

#include "station/analysis/trade.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

namespace {

/// Student's sleep data (1908): hours of sleep gained with two drugs by the same ten patients.
std::vector<PersonMeasure> sleep() {
  const std::vector<double> first{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
  const std::vector<double> second{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  std::vector<PersonMeasure> all;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto person = "P" + std::to_string(i);
    all.push_back({person, "one", "sleep", "h", first[i]});
    all.push_back({person, "two", "sleep", "h", second[i]});
  }
  return all;
}

bool within(const std::string&, const std::string&) { return false; }
bool between(const std::string& first, const std::string& second) { return first != second; }

}  // namespace

TEST_CASE("The effect of a condition is that of R's paired t test", "[group]") {
  // R's t.test(extra ~ group, sleep, paired = TRUE) gives 1.58, interval 0.7001142 to 2.4598858. The
  // differences have an SD of 1.229995, so d_z = 1.58 / 1.229995.
  const auto found = effects(sleep(), within);
  REQUIRE(found.size() == 1);
  CHECK(found[0].first == "one");
  CHECK(found[0].second == "two");
  CHECK(found[0].persons == 10);
  CHECK(found[0].difference->value == Approx(1.58));
  CHECK(found[0].difference->interval.low == Approx(0.7001142).epsilon(1e-6));
  CHECK(found[0].difference->interval.high == Approx(2.4598858).epsilon(1e-6));
  CHECK(*found[0].standardised == Approx(1.58 / 1.229995).epsilon(1e-5));
}

TEST_CASE("Means count each participant once, and effects only those with both conditions", "[group]") {
  auto measures = sleep();
  measures.erase(measures.begin());  // now P0 has a value for the second drug only
  const auto means = group_means(measures);
  REQUIRE(means.size() == 2);
  // conditions are in the order in which they first occur
  CHECK(means[0].condition == "two");
  CHECK(means[0].persons == 10);
  CHECK(means[0].mean->value == Approx(2.33));
  CHECK(means[0].sd == Approx(2.002249).epsilon(1e-6));
  CHECK(means[1].persons == 9);
  CHECK(effects(measures, within)[0].persons == 9);
}

TEST_CASE("The interval of a mean proportion stays between 0 and 1, and that of other measures is symmetric",
          "[group]") {
  std::vector<PersonMeasure> measures;
  for (const double share : {1.0, 1.0, 1.0, 0.6})
    for (const char* measure : {kCorrect, "proportion correct in time bin 1 of 5", kRocArea, "d'"})
      measures.push_back({"P" + std::to_string(measures.size()), "", measure, "", share});
  for (const auto& mean : group_means(measures)) {
    INFO(mean.measure);
    CHECK(mean.mean->value == Approx(0.9));
    if (mean.measure == "d'") {
      CHECK(mean.mean->interval.low == Approx(0.9 - 3.182446 * 0.1));
      CHECK(mean.mean->interval.high == Approx(0.9 + 3.182446 * 0.1));
    } else {
      // R: plogis(qlogis(0.9) + c(-1, 1) * qt(0.975, 3) * 0.1 / (0.9 * 0.1))
      CHECK(mean.mean->interval.low == Approx(0.2077).epsilon(1e-3));
      CHECK(mean.mean->interval.high == Approx(0.99677).epsilon(1e-4));
    }
  }
  for (const double all : {0.0, 1.0}) {
    const auto same = group_means(
        {{"a", "", kCorrect, "", all}, {"b", "", kCorrect, "", all}, {"c", "", kCorrect, "", all}});
    CHECK(same[0].mean->interval.low == all);
    CHECK(same[0].mean->interval.high == all);
  }
}

TEST_CASE("The effect between groups is that of R's Welch test", "[group]") {
  // R's t.test(extra ~ group, sleep) gives 1.58 for two - one, interval -0.2054832 to 3.3654832. The pooled
  // SD is 1.898625, so d_s = 1.58 / 1.898625.
  auto measures = sleep();
  for (auto& entry : measures)
    if (entry.condition == "two") entry.person += "b";
  const auto found = effects(measures, between);
  REQUIRE(found.size() == 1);
  CHECK(found[0].between_groups);
  CHECK(found[0].persons == 20);
  CHECK(found[0].second == "two");
  CHECK(found[0].difference->value == Approx(1.58));
  // wide margin, because the program's quantile of Student's t is accurate to 0.8 % only
  CHECK(found[0].difference->interval.low == Approx(-0.2054832).margin(0.015));
  CHECK(found[0].difference->interval.high == Approx(3.3654832).margin(0.015));
  CHECK(*found[0].standardised == Approx(1.58 / 1.898625).epsilon(1e-5));
  CHECK_FALSE(effects(sleep(), within)[0].between_groups);
  // nobody has both conditions, but everybody could have: an effect within participants, without an estimate
  const auto none = effects(measures, within);
  CHECK_FALSE(none[0].between_groups);
  CHECK(none[0].persons == 0);
  CHECK_FALSE(none[0].difference);
}

TEST_CASE("p values are those of R's t tests, and Holm's correction is R's p.adjust", "[group]") {
  // R's t.test(extra ~ group, sleep) gives p = 0.002833 if paired, and 0.07939 if not.
  CHECK(*effects(sleep(), within)[0].difference->p == Approx(0.002833).epsilon(2e-4));
  auto measures = sleep();
  for (auto& entry : measures)
    if (entry.condition == "two") entry.person += "b";
  CHECK(*effects(measures, between)[0].difference->p == Approx(0.07939).epsilon(2e-4));

  const auto corrected = [](const std::vector<double>& p) {
    std::vector<Tested> tests;
    for (const double one : p) tests.push_back({"", one});
    std::vector<double> found;
    for (const auto& one : holm(tests)) found.push_back(*one);
    return found;
  };
  // p.adjust(c(0.01, 0.04, 0.03, 0.005, 0.2), "holm"); then with ties, and with values that reach 1
  const std::vector<std::pair<std::vector<double>, std::vector<double>>> kByR{
      {{0.01, 0.04, 0.03, 0.005, 0.2}, {0.04, 0.09, 0.09, 0.025, 0.2}},
      {{0.02, 0.02, 0.5, 0.9}, {0.08, 0.08, 1, 1}}};
  for (const auto& [given, wanted] : kByR) {
    const auto found = corrected(given);
    for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(found[i] == Approx(wanted[i]));
  }
  CHECK(corrected({0.3}) == std::vector<double>{0.3});
  CHECK(corrected({}).empty());
  // families are corrected apart, and what has no p value does not count
  const auto apart = holm({{"a", 0.02}, {"b", 0.04}, {"a", std::nullopt}, {"a", 0.03}});
  CHECK(*apart[0] == Approx(0.04));
  CHECK(*apart[1] == Approx(0.04));
  CHECK_FALSE(apart[2]);
  CHECK(*apart[3] == Approx(0.04));
}

TEST_CASE("Two participants have no interval", "[group]") {
  const std::vector<PersonMeasure> two{
      {"A", "x", "m", "", 1}, {"B", "x", "m", "", 2}, {"A", "y", "m", "", 3}};
  CHECK_FALSE(group_means(two)[0].mean);
  CHECK_FALSE(effects(two, within)[0].difference);
  CHECK(effects(two, within)[0].persons == 1);
}
