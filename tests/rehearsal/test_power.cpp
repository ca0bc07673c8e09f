#include "station/rehearsal/power.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "station/core/usage_error.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/rehearsal/reward.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/number_from.hpp"
#include "tests/support/replaced.hpp"

using namespace turnpoint;

namespace {

protocol::Protocol shipped(const std::string& name) {
  return protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

const rehearsal::Recovery& find(const rehearsal::Power& power, std::string_view source,
                                std::string_view parameter) {
  for (const auto& recovery : power.recoveries)
    if (recovery.source == source && recovery.parameter == parameter) return recovery;
  throw std::out_of_range("no " + std::string(parameter) + " of " + std::string(source));
}

rehearsal::PowerOptions options(const std::string& observer, int observers, int intervals = 0) {
  rehearsal::PowerOptions options;
  options.observers = observers;
  options.interval_sessions = intervals;
  options.replicates = 40;
  options.observer = simulation::parse(observer);
  return options;
}

}  // namespace

TEST_CASE("the point of subjective equality that sessions find is the observer's own bias", "[power]") {
  const auto protocol = shipped("boundary-constant");
  for (const double bias : {0.0, 5.0}) {
    const auto power =
        rehearsal::power(protocol, options("sim:threshold=8,bias=" + std::to_string(bias), 40));
    const auto& pse = find(power, "fit", "PSE");
    REQUIRE(pse.truth.has_value());
    CHECK(*pse.truth == Approx(bias).margin(0.8));
    CHECK(std::fabs(*pse.bias) < 4 * pse.sd / std::sqrt(40.0));
    CHECK(pse.estimates.size() == 40);
  }
}

TEST_CASE(
    "the truth of a staircase is where its rule balances, and that of a posterior follows from its function",
    "[power]") {
  const auto stairs =
      rehearsal::power(shipped("friction-staircase"), options("sim:threshold=-16,lapse=0", 2));
  // A three-down-one-up staircase converges on 79.37 %; the observer reaches 75 % at -16 dB.
  const auto truth = *find(stairs, "procedure a", "threshold").truth;
  simulation::Question question;
  question.level = truth, question.decibel = true, question.correct = 0, question.deadline_s = 3;
  const simulation::Observer observer(simulation::parse("sim:threshold=-16,lapse=0"));
  CHECK(observer.share(question, 0) == Approx(0.793701).margin(1e-6));
  const auto quest = rehearsal::power(shipped("friction-2ifc"), options("sim:threshold=-16,lapse=0", 2));
  question.level = *find(quest, "procedure threshold", "threshold").truth;
  CHECK(observer.share(question, 0) == Approx(1 - 0.5 * std::exp(-1.0)).margin(1e-6));
}

TEST_CASE("the true values are the observer's own parameters, never estimates", "[power]") {
  const auto power = rehearsal::power(shipped("speed-accuracy"), options("sim:threshold=0.15", 6, 6));
  const auto& right = find(power, "accuracy - speed", "proportion correct");
  CHECK(right.mean > 0);  // the speed instruction reduces accuracy
  CHECK(find(power, "accuracy - speed", "median response time").mean > 0);
  REQUIRE((right.truth && right.coverage && right.interval_width));
  CHECK(right.coverage->trials == static_cast<int>(right.estimates.size()));
  CHECK(std::fabs(*right.bias) < 2 * *right.interval_width);
  // With a deadline of 0.8 s, residual and travel time leave 0.3 s for the decision, and the observer lowers
  // its bound to sqrt(0.35 x 0.3), so that it decides in time. The boundary a of EZ-diffusion is 0.2 times
  // the bound.
  const double hurried = std::sqrt(0.35 * 0.3), careful = std::sqrt(0.35 * 1.5);
  CHECK(*find(power, "accuracy - speed", "boundary").truth == Approx(0.2 * (careful - hurried)));
  CHECK(*find(power, "accuracy - speed", "time outside the decision").truth == 0);
  CHECK_FALSE(find(power, "accuracy - speed", "LISAS").truth);
  auto again = options("sim:threshold=0.15", 6, 6);
  again.seed = 1000;
  const auto other = rehearsal::power(shipped("speed-accuracy"), again);
  CHECK(other.recoveries.size() == power.recoveries.size());
  for (const auto& recovery : other.recoveries)
    if (recovery.parameter !=
        "proportion correct")  // this is a proportion of all trials; the other parameters leave out timeouts
      CHECK(recovery.truth == find(power, recovery.source, recovery.parameter).truth);
}

TEST_CASE("the diffusion's parameters in each condition are recovered, as the report prints them",
          "[power]") {
  // TURNPOINT_POWER_SESSIONS=200 for more
  const int sessions = number_from("TURNPOINT_POWER_SESSIONS", 12);
  const auto power =
      rehearsal::power(shipped("speed-accuracy"), options("sim:threshold=0.15,lapse=0", sessions, sessions));
  const double hurried = 0.2 * std::sqrt(0.35 * 0.3);
  CHECK(*find(power, "diffusion speed", "boundary").truth == Approx(hurried));
  CHECK(*find(power, "diffusion accuracy", "time outside the decision").truth == 0.5);
  for (const auto* source : {"diffusion speed", "diffusion accuracy"})
    for (const auto* parameter : {"boundary", "time outside the decision", "drift"}) {
      const auto& found = find(power, source, parameter);
      INFO(source << ", " << parameter << ": " << found.mean << " +- " << found.sd << ", covered "
                  << found.coverage->value);
      REQUIRE((found.truth && found.coverage));
      CHECK(found.coverage->trials == sessions);
      CHECK(found.coverage->right >= 0.75 * sessions);
      CHECK_FALSE(found.claimed);  // only differences can be claimed
    }
  // the accuracy instruction raises the boundary, which most sessions claim; drift is the same, so a claim
  // would be a false alarm
  CHECK(find(power, "accuracy - speed", "boundary").claimed->value > 0.9);
  REQUIRE(find(power, "accuracy - speed", "drift").claimed);
  CHECK(find(power, "accuracy - speed", "drift").claimed->value < 0.4);
  REQUIRE(power.misfits);
  CHECK(power.misfits->trials == sessions);
  CHECK(power.misfits->value < 0.4);
}

TEST_CASE(
    "curves at a response signal are planned: the truth is the best curve through the observer's answers",
    "[power]") {
  const auto power = rehearsal::power(shipped("response-signal"), options("sim:lapse=0", 8, 8));
  for (const auto* parameter : {"asymptote of d'", "rate of d'", "intercept of d'"}) {
    const auto& found = find(power, "signal", parameter);
    INFO(parameter << ": truth " << *found.truth << ", median " << found.median);
    REQUIRE(found.truth);
    REQUIRE(found.coverage);
    CHECK(found.coverage->right >= found.coverage->trials - 2);
  }
  // ever more trials come to this truth
  auto longer = shipped("response-signal");
  for (auto& spec : longer.procedures) spec.repeats *= 40;
  const auto exact = rehearsal::power(longer, options("sim:lapse=0", 1, 1));
  CHECK(find(exact, "signal", "asymptote of d'").mean ==
        Approx(*find(power, "signal", "asymptote of d'").truth).epsilon(0.06));
  CHECK(find(exact, "signal", "intercept of d'").mean ==
        Approx(*find(power, "signal", "intercept of d'").truth).margin(0.04));
}

TEST_CASE("studies of several people are planned with the effects that their report prints", "[power]") {
  auto wanted = options("sim:threshold=0.15", 12);
  wanted.people = 4;
  wanted.between = simulation::parse_spread("threshold=0.03,bound=0.15,residual=0.1");
  const auto power = rehearsal::power(shipped("speed-accuracy"), wanted);
  CHECK(power.people == 4);
  const auto& boundary = find(power, "accuracy - speed", "boundary");
  CHECK(boundary.estimates.size() == 3);
  CHECK(boundary.sessions == 3);
  REQUIRE((boundary.truth && boundary.claimed && boundary.coverage));
  CHECK(*boundary.truth > 0.03);
  CHECK(boundary.claimed->trials == 3);
  for (const auto* measure : {"time outside the decision", "drift"})
    CHECK(*find(power, "accuracy - speed", measure).truth == 0);
  CHECK(find(power, "accuracy - speed", "BIS").estimates.size() == 3);  // only a study has it
  const auto& mean = find(power, "mean speed", "time outside the decision");
  CHECK(*mean.truth == Approx(0.5).margin(0.08));  // people differ, so it is the mean of those who were drawn
  CHECK_THROWS(find(power, "diffusion speed", "boundary"));
  // someone who differs in nothing is the observer; the more people differ, the more uncertain a study is
  auto alike = wanted;
  alike.between = simulation::parse_spread("residual=1e-9");
  CHECK(*find(rehearsal::power(shipped("speed-accuracy"), alike), "mean speed", "time outside the decision")
             .truth == Approx(0.5));
  auto uneven = wanted;
  uneven.observers = 10;
  CHECK_THROWS_AS(rehearsal::power(shipped("speed-accuracy"), uneven), std::invalid_argument);
}

TEST_CASE("people are drawn around the observer, each parameter by itself", "[power]") {
  const auto middle = simulation::parse("sim:threshold=6,bound=0.8");
  const auto people = [&](const char* text) {
    std::vector<simulation::Parameters> all;
    for (int i = 0; i < 400; ++i) {
      core::Draws draws({1, core::Stream::observer, -1, 0, i});
      all.push_back(simulation::draw_person(middle, simulation::parse_spread(text), draws));
    }
    return all;
  };
  const auto some = people("bound=0.2"), more = people("bound=0.2,threshold=3");
  double squares = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const double gap = std::log(some[i].bound / 0.8);
    squares += gap * gap / 400;
    CHECK(some[i].bound == more[i].bound);
    CHECK(some[i].residual_s == middle.residual_s);
    CHECK(*some[i].threshold == 6);
    CHECK(*more[i].threshold >= 0.6);
  }
  CHECK(std::sqrt(squares) == Approx(0.2).epsilon(0.15));
  core::Draws draws({});
  CHECK_THROWS_WITH(
      simulation::draw_person(simulation::parse("sim"), simulation::parse_spread("threshold=1"), draws),
      Catch::Matchers::ContainsSubstring("write sim:threshold="));
  for (const auto* wrong : {"", "bound", "bound=", "bound=-1", "bound=0", "bounds=1", "bound=0.1;slope=1"})
    CHECK_THROWS_AS(simulation::parse_spread(wrong), core::UsageError);
}

TEST_CASE("a fit finds the observer's own threshold and slope", "[power]") {
  const auto power =
      rehearsal::power(shipped("friction-2ifc"), options("sim:threshold=-18,slope=1.3,lapse=0", 3));
  CHECK(*find(power, "fit", "slope").truth == 1.3);
  CHECK(*find(power, "fit", "75 % point").truth == Approx(-18));
  CHECK(*find(power, "fit", "threshold").truth == Approx(-18 + 20 / 1.3 * std::log10(1 / std::log(2.0))));
  const auto sides = rehearsal::power(shipped("boundary-constant"), options("sim:threshold=6,lapse=0.02", 3));
  CHECK(*find(sides, "fit", "PSE").truth == 0);
  CHECK(*find(sides, "fit", "spread").truth == Approx(6 / 0.6744897501960817));
}

TEST_CASE("the fits of every group have a truth", "[power]") {
  std::ifstream file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/friction-2ifc.toml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text +=
      "\n[[factor]]\nname = \"training\"\nlevels = [\"trained\", \"none\"]\ndraw = \"per-participant\"\n"
      "\n[analysis]\nby = \"training\"\n";
  const auto power = rehearsal::power(protocol::parse(text, "groups.toml"), options("sim:threshold=-18", 4));
  REQUIRE(find(power, "fit trained", "threshold").truth);
  CHECK(find(power, "fit trained", "threshold").truth == find(power, "fit none", "threshold").truth);
}

TEST_CASE("slopes and spreads are summarised by median and quartiles, and their bias is that of the median",
          "[power]") {
  const auto power = rehearsal::power(shipped("boundary-constant"), options("sim:threshold=8", 9));
  const auto& spread = find(power, "fit", "spread");
  CHECK(spread.heavy_tailed);
  auto sorted = spread.estimates;
  std::sort(sorted.begin(), sorted.end());
  REQUIRE(sorted.size() == 9);
  CHECK(spread.median == sorted[4]);
  CHECK(spread.lower_quartile == sorted[2]);
  CHECK(spread.upper_quartile == sorted[6]);
  CHECK(*spread.bias == spread.median - *spread.truth);
  const auto& pse = find(power, "fit", "PSE");
  CHECK_FALSE(pse.heavy_tailed);
  CHECK(*pse.bias == pse.mean - *pse.truth);
  for (const auto& recovery : power.recoveries) CHECK(!recovery.unit.empty());
}

TEST_CASE("the results do not depend on the number of threads", "[power]") {
  auto one = options("sim", 8), three = one;
  one.threads = 1, three.threads = 3;
  const auto a = rehearsal::power(shipped("boundary-constant"), one);
  const auto b = rehearsal::power(shipped("boundary-constant"), three);
  REQUIRE(a.recoveries.size() == b.recoveries.size());
  for (std::size_t i = 0; i < a.recoveries.size(); ++i)
    CHECK(a.recoveries[i].estimates == b.recoveries[i].estimates);
}

TEST_CASE("a stopped study gives the result of fewer observers", "[power]") {
  const auto protocol = shipped("friction-staircase");
  auto stopped = options("sim", 50, 3);
  std::stop_source stop;
  stopped.threads = 3;
  stopped.stop = stop.get_token();
  stopped.progress = [&stop](int done, int) {
    if (done == 5) stop.request_stop();
  };
  const auto some = rehearsal::power(protocol, stopped);
  CHECK(some.asked == 50);
  REQUIRE(some.observers >= 5);
  REQUIRE(some.observers <= 7);  // each thread may have begun another session
  const auto fewer = rehearsal::power(protocol, options("sim", some.observers, 3));
  REQUIRE(some.recoveries.size() == fewer.recoveries.size());
  for (std::size_t i = 0; i < some.recoveries.size(); ++i) {
    CHECK(some.recoveries[i].estimates == fewer.recoveries[i].estimates);
    CHECK(some.recoveries[i].truth == fewer.recoveries[i].truth);
    CHECK(some.recoveries[i].interval_width == fewer.recoveries[i].interval_width);
  }
  CHECK(rehearsal::power(protocol, stopped).observers == 0);  // stopped before it began
}

TEST_CASE("the parts of a study contain each session once", "[power]") {
  for (const auto& [observers, parts] : {std::pair{10, 3}, {12, 4}, {5, 5}, {1000, 64}}) {
    int sum = 0;
    for (int number = 1; number <= parts; ++number) sum += rehearsal::sessions_of({number, parts}, observers);
    CHECK(sum == observers);
  }
  auto none = options("sim", 4);
  none.part = {5, 5};
  CHECK_THROWS_AS(rehearsal::power(shipped("demo"), none), std::invalid_argument);
}

TEST_CASE("settings estimate the observer's bias, and their intervals contain it", "[power]") {
  const auto power =
      rehearsal::power(shipped("boundary-adjustment"), options("sim:threshold=4,bias=3,lapse=0", 300, 300));
  REQUIRE(power.recoveries.size() == 1);
  const auto& pse = power.recoveries.front();
  CHECK(pse.parameter == "PSE");
  REQUIRE(pse.truth);
  CHECK(*pse.truth == 3);
  CHECK(std::abs(*pse.bias) < 0.3);
  REQUIRE(pse.coverage);
  CHECK(pse.coverage->value > 0.9);
}

TEST_CASE("the method of limits finds the middle between its symmetric series", "[power]") {
  const auto power =
      rehearsal::power(shipped("limits-boundary"), options("sim:threshold=4,bias=0,lapse=0", 300));
  const auto& threshold = find(power, "procedure series", "threshold");
  CHECK(*threshold.truth == 0);
  CHECK(std::abs(*threshold.bias) < 4 * threshold.sd / std::sqrt(300.0));
  // With a shallow function some answers change by chance, and too early in both directions.
  CHECK(find(power, "procedure series", "threshold ascending - descending").mean < -3);
}

TEST_CASE("a study of several days analyses all sessions of a participant together", "[power]") {
  const auto power = rehearsal::power(shipped("friction-training"), options("sim:threshold=-15,lapse=0", 4));
  // Expected number of trials: 6 practice trials, 60 to measure the threshold on two days, 60 of training on
  // each of three days, and some that were not answered in time
  CHECK(power.trials >= 306);
  CHECK(power.trials < 325);
  for (const auto* source : {"procedure before, session 1", "procedure after, session 3"}) {
    const auto& threshold = find(power, source, "threshold");
    CHECK(threshold.estimates.size() == 4);
    REQUIRE(threshold.truth);
    CHECK(threshold.mean == Approx(*threshold.truth).margin(4));
  }
  CHECK_THROWS(find(power, "procedure before, session 3", "threshold"));
  // Two of the four participants belong to each group. Each session has random draws of its own.
  for (const auto* source : {"fit feedback, before", "fit none, before", "fit none, after"})
    CHECK(find(power, source, "threshold").estimates.size() == 2);
  CHECK(find(power, "procedure training, session 1", "threshold").estimates !=
        find(power, "procedure training, session 2", "threshold").estimates);
}

TEST_CASE("options out of range are refused", "[power]") {
  CHECK_THROWS_AS(rehearsal::power(shipped("demo"), options("sim", 0)), std::invalid_argument);
}

TEST_CASE("each parallel task runs once, and an exception in one of them reaches the caller", "[power]") {
  std::atomic<int> sum = 0;
  int last = 0;
  rehearsal::in_parallel(
      100, 3, [&](int done, int) { last = done; }, [&](int i) { sum += i; });
  CHECK(sum == 4950);
  CHECK(last == 100);
  CHECK_THROWS_AS(rehearsal::in_parallel(5, 2, {},
                                         [](int i) {
                                           if (i == 3) throw std::runtime_error("three");
                                         }),
                  std::runtime_error);
}

TEST_CASE("the exponent that sessions find is the observer's own slope, and ratings are refused", "[power]") {
  const auto power = rehearsal::power(shipped("magnitude-free"), options("sim:slope=0.6,lapse=0", 60));
  const auto& exponent = find(power, "numbers", "exponent");
  CHECK(*exponent.truth == 0.6);
  CHECK(std::fabs(*exponent.bias) < 4 * exponent.sd / std::sqrt(60.0));
  REQUIRE(exponent.coverage);
  CHECK(exponent.coverage->value > 0.85);
  CHECK_THROWS_WITH(rehearsal::power(shipped("smoothness-line"), options("sim", 2)),
                    Catch::Matchers::ContainsSubstring("ratings have no threshold"));
}

TEST_CASE("the proportion correct of an identification is the observer's own, and its intervals contain it",
          "[power]") {
  const auto power = rehearsal::power(shipped("friction-identification"), options("sim:lapse=0", 200, 200));
  const auto& right = find(power, "answers", "proportion correct");
  // Neighbours are told apart in 75 % of trials, so answers are right in 50 % for the three inner stimuli and
  // in 75 % for the two outer ones.
  REQUIRE(right.truth.has_value());
  CHECK(*right.truth == Approx(0.6).margin(1e-9));
  CHECK(std::fabs(*right.bias) < 4 * right.sd / std::sqrt(200.0));
  REQUIRE(right.coverage);
  CHECK(right.coverage->value >= 0.92);
}

TEST_CASE("the truth of a scale is that of the simulated observer, bent or not, and intervals contain it",
          "[power]") {
  const auto triads =
      rehearsal::power(shipped("friction-triads"), options("sim:threshold=3,slope=2,lapse=0", 60));
  // a power function over the range from -24 to -4 dB
  for (const auto& [place, truth] :
       {std::pair{"place of -18 dB", 0.09}, {"place of -14 dB", 0.25}, {"place of -8 dB", 0.64}}) {
    const auto& found = find(triads, "scale", place);
    REQUIRE(found.truth);
    CHECK(*found.truth == Approx(truth).margin(1e-5));
    CHECK(std::fabs(*found.bias) < 4 * found.sd / std::sqrt(60.0) + 0.01);
    REQUIRE(found.coverage);
    CHECK(found.coverage->value >= 0.85);
  }
  CHECK(*find(triads, "scale", "noise of a comparison").truth == Approx(3 / 0.6744898 / 20).epsilon(1e-4));
  CHECK(*find(triads, "scale", "tendency to answer second").truth == Approx(0).margin(1e-6));
  // twice the trials, and intervals that are narrower by the square root of 2
  auto twice = shipped("friction-triads");
  twice.procedures.front().repeats *= 2;
  const auto longer = rehearsal::power(twice, options("sim:threshold=3,slope=2,lapse=0", 20));
  CHECK(*find(longer, "scale", "place of -14 dB").interval_width ==
        Approx(*find(triads, "scale", "place of -14 dB").interval_width / std::sqrt(2.0)).epsilon(0.15));
  // All people of a study have the same scale here, which is the truth of its mean.
  auto study = options("sim:threshold=4,lapse=0", 12);
  study.people = 6;
  const auto people = rehearsal::power(shipped("friction-pairs"), study);
  const auto single = rehearsal::power(shipped("friction-pairs"), options("sim:threshold=4,lapse=0", 3));
  const auto& mean = find(people, "mean", "place of -24 dB");
  REQUIRE(mean.truth);
  CHECK(*mean.truth == Approx(*find(single, "scale", "place of -24 dB").truth).epsilon(1e-3));
  CHECK(*mean.truth < -3);
}

TEST_CASE("a power study says in how many sessions the prior decides about a scale", "[power]") {
  // an observer for whom neighbours are far apart is never inconsistent
  const auto sharp = rehearsal::power(shipped("friction-pairs"), options("sim:threshold=1,lapse=0", 12));
  REQUIRE(sharp.separated);
  CHECK(sharp.separated->trials == 12);
  CHECK(sharp.separated->value == 1);
  CHECK(find(sharp, "scale", "place of -24 dB").coverage->value < 0.5);
  const auto blunt = rehearsal::power(shipped("friction-pairs"), options("sim:threshold=8,lapse=0", 12));
  REQUIRE(blunt.separated);
  CHECK(blunt.separated->value == 0);
  auto study = options("sim:threshold=1,lapse=0", 12);
  study.people = 6;
  const auto people = rehearsal::power(shipped("friction-pairs"), study);
  REQUIRE(people.separated);
  CHECK(people.separated->value == 1);
  CHECK(!rehearsal::power(shipped("boundary-constant"), options("sim", 2)).separated);
}

TEST_CASE(
    "d' of ABX and of three intervals is found as in the report, and its intervals contain the true value",
    "[power]") {
  auto long_abx = shipped("friction-abx");
  long_abx.procedures.front().repeats = 150;  // with few trials, the estimate is biased
  const auto abx = rehearsal::power(long_abx, options("sim:threshold=-12,lapse=0", 100, 0));
  for (const auto* model : {"d', independent observations", "d', differencing"}) {
    const auto& all = find(abx, "answers", model);
    REQUIRE(all.truth);
    CHECK(std::abs(*all.bias) < 0.03);
    CHECK(all.estimates.size() == 100);
  }
  // The observer decides by differencing. At a single level its true d' is known, because no levels are
  // mixed.
  double last = 0;
  for (const auto* level : {"-20", "-15", "-10", "-5"}) {
    const auto& at = find(abx, "answers", std::string("d', differencing, at ") + level + " dB");
    REQUIRE(at.truth);
    CHECK(*at.truth > last);
    last = *at.truth;
    REQUIRE(at.coverage);
    // intervals of Clopper and Pearson are longer than necessary, so they contain the true value more often
    // than 95 %
    CHECK(at.coverage->value > 0.9);
  }
  // Adaptive levels differ from session to session: only d' over all trials can be compared.
  const auto three = rehearsal::power(shipped("friction-3ifc"), options("sim:threshold=-12,lapse=0", 20, 0));
  CHECK(find(three, "answers", "d', largest of m").truth);
  int rows = 0;
  for (const auto& entry : three.recoveries) rows += entry.source == "answers";
  CHECK(rows == 1);
}

TEST_CASE("a procedure over two dimensions recovers the observer's threshold and gradient", "[power]") {
  const auto power = rehearsal::power(shipped("friction-boundary-2d"),
                                      options("sim:threshold=-16,gradient=0.08,slope=1.3,lapse=0.02", 30));
  const std::string source = "procedure surface";
  const auto& threshold = find(power, source, "threshold");
  // where the observer's Weibull function has the value 1 - 1/e of the way between its asymptotes
  CHECK(*threshold.truth == Approx(-16 + 20 / 1.3 * std::log10(1 / std::log(2.0))).margin(1e-6));
  CHECK(*find(power, source, "gradient").truth == 0.08);
  CHECK(find(power, source, "gradient").unit == "dB/mm");
  CHECK(*find(power, source, "slope").truth == 1.3);
  CHECK(*find(power, source, "lapse").truth == Approx(0.01));
  for (const auto* parameter : {"threshold", "gradient"}) {
    const auto& found = find(power, source, parameter);
    INFO(parameter << ": " << found.mean << ", truth " << *found.truth);
    CHECK(std::fabs(*found.bias) < 4 * found.sd / std::sqrt(30.0) + 0.1 * std::fabs(*found.truth));
    REQUIRE(found.coverage);
    CHECK(found.coverage->trials == 30);
    CHECK(found.coverage->right >= 25);
  }
  // one psychometric function cannot describe trials whose threshold differs
  for (const auto& recovery : power.recoveries) CHECK_FALSE(recovery.source.starts_with("fit"));
}

TEST_CASE("a procedure with a criterion recovers the observer's criterion, wherever it lies", "[power]") {
  for (const double criterion : {0.3, 1.5}) {
    const auto power = rehearsal::power(
        shipped("friction-yes-no"),
        options("sim:threshold=0.1,slope=1.4,lapse=0.02,criterion=" + std::to_string(criterion), 30));
    const std::string source = "procedure detection";
    CHECK(*find(power, source, "criterion").truth == Approx(criterion));
    // d' is 1.349 at the observer's threshold
    CHECK(*find(power, source, "threshold").truth ==
          Approx(0.1 * std::pow(1.3489795, -1 / 1.4)).epsilon(1e-5));
    CHECK(*find(power, source, "lapse").truth == Approx(0.01));
    for (const auto* parameter : {"threshold", "criterion"}) {
      const auto& found = find(power, source, parameter);
      INFO(parameter << ": " << found.mean << ", truth " << *found.truth);
      CHECK(std::fabs(*found.bias) < 4 * found.sd / std::sqrt(30.0) + 0.1 * std::fabs(*found.truth));
      CHECK(found.coverage->right >= 25);
    }
    CHECK(find(power, "fit", "threshold").estimates.size() > 20);
  }
}

// Bogacz et al. 2006: with drift v and bounds b away from the start, a decision takes (b / v) tanh(v b) s and
// is right with probability 1 / (1 + exp(-2 v b)).
TEST_CASE("the observer who maximises the reward has the boundaries of the closed form", "[power][reward]") {
  const auto slow = replaced(shipped("reward-rate").source, "deadline_s = 2.0", "deadline_s = 30.0");
  const auto protocol =
      protocol::parse(replaced(slow, "explore_s = 4.0", "explore_s = 32.0"), "reward-rate.toml");
  for (const double threshold : {0.1, 0.25}) {
    const auto study = options("sim:lapse=0,threshold=" + std::to_string(threshold), 1);
    const auto rewards = rehearsal::best_rewards(protocol, study);
    REQUIRE(rewards.size() == 2);
    simulation::Question question;
    question.decides = simulation::Decides::side, question.level = 0.2;
    const simulation::Observer observer(study.observer);
    const double drift = observer.drift(question), own_bound = study.observer.bound;
    for (const auto& reward : rewards) {
      const double delay_s = reward.block.find("1.5") == std::string::npos ? 0 : 1.5;
      const auto right = [&](double bound) { return 1 / (1 + std::exp(-2 * drift * bound)); };
      const auto decision_s = [&](double bound) { return bound / drift * std::tanh(drift * bound); };
      // what a trial takes besides the decision and the delay, from what the observer's own boundaries earn
      const double rest_s = 60 * right(own_bound) / reward.own.points_per_minute - decision_s(own_bound) -
                            delay_s * (1 - right(own_bound));
      const auto rate = [&](double bound) {
        return 60 * right(bound) / (rest_s + decision_s(bound) + delay_s * (1 - right(bound)));
      };
      double best = 0.01;
      for (double bound = 0.01; bound < 4; bound += 0.001)
        if (rate(bound) > rate(best)) best = bound;
      CAPTURE(threshold, reward.block, rest_s, best / own_bound);
      CHECK_FALSE(reward.at_end);
      CHECK(reward.caution == Approx(best / own_bound).epsilon(0.2));
      CHECK(rate(reward.caution * own_bound) > 0.99 * rate(best));
      CHECK(reward.best.points_per_minute == Approx(rate(best)).epsilon(0.03));
      CHECK(reward.own.right == Approx(right(own_bound)).margin(0.02));
      CHECK(reward.best.right == Approx(right(reward.caution * own_bound)).margin(0.02));
    }
    CHECK(rewards[1].caution > rewards[0].caution);  // delays make care pay
    // the study's observer has these boundaries, and his sessions earn more
    auto maximises = study;
    maximises.observers = maximises.interval_sessions = 8;
    maximises.cautions = rehearsal::cautions_of(rewards);
    const auto power = rehearsal::power(protocol, maximises);
    const auto& boundary = find(power, "diffusion penalty 1.5 s", "boundary");
    CHECK(*boundary.truth == Approx(0.2 * rewards[1].caution * own_bound));
    CHECK(boundary.mean == Approx(*boundary.truth).epsilon(0.15));
  }
}

TEST_CASE(
    "where guessing at once or endless care pays, the search says that it ended there, and without points it "
    "refuses",
    "[power][reward]") {
  const auto with = [&](const std::string& points) {
    const auto text = replaced(shipped("reward-rate").source, "right = 1\n", points + "\n");
    return rehearsal::best_rewards(protocol::parse(text, "reward-rate.toml"),
                                   options("sim:threshold=0.1", 1));
  };
  const auto equal = with("right = 1\nwrong = 1\nlate = -5");
  REQUIRE(equal.size() == 2);
  CHECK(equal[0].at_end);
  CHECK(equal[0].caution == Approx(rehearsal::kLeastCaution));
  CHECK_FALSE(equal[1].at_end);  // here a wrong answer costs time
  for (const auto& reward : with("right = 0\nwrong = -100\nlate = 0")) {
    CHECK(reward.at_end);
    CHECK(reward.caution == Approx(rehearsal::kMostCaution));
  }
  CHECK_THROWS_AS(rehearsal::best_rewards(shipped("friction-2ifc"), options("sim", 1)), core::UsageError);
}
