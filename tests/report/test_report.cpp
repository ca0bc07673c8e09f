#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "station/core/number.hpp"
#include "station/report/chart.hpp"
#include "station/report/document.hpp"
#include "station/report/figure_files.hpp"
#include "station/report/figures.hpp"
#include "station/report/words.hpp"
#include "tests/report/simulated_report.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/diffusion.hpp"

using namespace turnpoint;
using namespace turnpoint::report;

namespace {

SessionData head() {
  SessionData data;
  data.title = "A change of friction <under> the finger";
  data.participant = "P01";
  data.session_id = "s1";
  data.run_mode = "simulated";
  data.status = "completed";
  data.facts = {{"Protocol", "speed-accuracy-change 1.0.0"}};
  data.health = {{core::plain("Underruns"), core::plain("0")}};
  data.level_label = core::plain("Change of friction");
  data.choices = {"Smoother", "Rougher"};
  data.replicates = 200;
  return data;
}

SessionData speed_accuracy(int per_level) {
  auto data = head();
  data.design = Design::two_sided;
  data.function = core::Function::normal;
  core::Draws draws({3, core::Stream::observer, 0, 0, 0});
  for (const auto& [name, boundary] : {std::pair{"speed", 0.08}, {"accuracy", 0.14}})
    for (int i = 0; i < per_level; ++i)
      for (const double level : {-0.4, -0.2, -0.1, 0.1, 0.2, 0.4}) {
        analysis::TrialRecord trial;
        trial.trial_index = static_cast<int>(data.trials.size());
        trial.instruction = name;
        trial.procedure = "levels";
        trial.level = level;
        trial.difficulty = std::abs(level);
        trial.right_choice = level > 0;
        const auto decision = tests::sample_decision({0.6 * std::abs(level), boundary, 0.3}, draws);
        trial.correct = decision.correct;
        trial.response = decision.correct ? *trial.right_choice : 1 - *trial.right_choice;
        trial.response_time_s = decision.time_s;
        data.trials.push_back(trial);
      }
  return data;
}

SessionData staircase_session() {
  auto data = head();
  data.level_label = core::plain("Friction contrast (dB)");
  data.level_unit = "dB";
  data.choices = {"First", "Second"};
  core::Draws draws({4, core::Stream::observer, 0, 0, 0});
  double level = -10;
  for (int i = 0; i < 120; ++i) {
    analysis::TrialRecord trial;
    trial.trial_index = i;
    trial.procedure = "staircase";
    trial.level = level;
    trial.right_choice = static_cast<int>(draws.below(2));
    const double p = analysis::probability(data.function, data.scale, {-19, 1.5, 0.5, 0.02}, level);
    trial.correct = draws.uniform() < p;
    trial.response = *trial.correct ? *trial.right_choice : 1 - *trial.right_choice;
    trial.response_time_s = 0.4 + 0.3 * draws.uniform();
    level += *trial.correct ? -1 : 3;
    data.trials.push_back(trial);
  }
  return data;
}

void keep(const std::string& name, const std::string& text) {
  if (const char* folder = std::getenv("TURNPOINT_KEEP_PLOTS"))
    std::ofstream(std::string(folder) + "/" + name) << text;
}

/// The words of a text, in English.
std::string said(const Text& text) {
  std::string all;
  for (const auto& run : text.runs)
    if (const auto* phrase = std::get_if<core::Phrase>(&run.what)) all += core::say(*phrase, "en");
  return all;
}

std::string shown(const std::optional<report::Figure>& figure) {
  REQUIRE(figure);
  const auto svg = report::render(*figure);
  CHECK(svg.find("nan") == std::string::npos);
  return svg;
}

}  // namespace

TEST_CASE("A speed-accuracy session gives fits, the trade with intervals, and all pictures", "[report]") {
  const auto summary = summarise(speed_accuracy(28));
  REQUIRE(summary.fits.size() == 2);
  CHECK(summary.fits[0].fit.parameters.has_value());
  CHECK(summary.fits[0].positive == "\u201cRougher\u201d");
  REQUIRE(summary.trade.differences.size() == 7 + 5 + 1);  // five bins of time, and d'
  CHECK(summary.trade.differences[2].estimate->interval.low > 0);
  keep("psychometric.svg", shown(psychometric_figure(summary)));
  keep("trace.svg", shown(trace_figure(summary)));
  keep("times.svg", shown(response_time_figure(summary)));
  keep("trade.svg", shown(trade_figure(summary)));
  // on a panel of 800 x 480 px its charts stand below each other
  const auto scrolled = laid_out_to_scroll(*trade_figure(summary), 360, 200);
  CHECK(size_px(scrolled).first == 360);
  CHECK(scrolled.columns == 1);
  keep("trade-scrolled.svg", shown(scrolled));
  const auto html = to_html(summary);
  keep("report.html", html);
  CHECK(html == to_html(summarise(speed_accuracy(28))));
  CHECK(html.find("&lt;under&gt;") != std::string::npos);
  CHECK(html.find("<script") == std::string::npos);
  CHECK(html.find("accuracy \u2212 speed") != std::string::npos);
  CHECK(html.find("answers under <b>accuracy</b> came ") != std::string::npos);
  CHECK(html.find(" later (median) and were right ") != std::string::npos);
  CHECK(html.find("The boundary was higher (more caution); the drift did not change detectably.") !=
        std::string::npos);
  CHECK(html.find("class=\"mode\">simulated") != std::string::npos);
  CHECK(html.find("Trials of practice are left out.") != std::string::npos);
  const auto json = nlohmann::json::parse(to_json(summary));
  CHECK(json["instructions"].size() == 2);
  CHECK(json["differences"][2]["estimate"]["value"].get<double>() > 0.03);
}

TEST_CASE(
    "The macro trade has d' and time of each condition with their intervals, as figure and in the table",
    "[report]") {
  const auto data = speed_accuracy(28);
  const auto summary = summarise(data);
  const auto figure = macro_figure(summary);
  keep("macro.svg", shown(figure));
  const auto detections =
      analysis::detect(data.trials, {}, analysis::Detecting::sides, 1);  // an independent way to the counts
  std::size_t points = 0;
  for (const auto& layer : figure->charts[0].layers)
    if (const auto* point = std::get_if<report::Points>(&layer)) {
      const auto& entry = summary.trade.instructions[points++];
      CHECK(point->x[0] == entry.median_s->value);
      const auto found = std::find_if(detections.begin(), detections.end(), [&](const auto& one) {
        return !one.level && one.condition == entry.instruction;
      });
      CHECK(point->y[0] == found->d_prime->value);
      CHECK(point->low[0] == found->d_prime->interval.low);
      CHECK(point->high[0] == found->d_prime->interval.high);
    }
  CHECK(points == 2);
  const auto& gap = summary.trade.differences.back();
  CHECK(gap.measure == "d'");
  CHECK(gap.estimate->value ==
        Approx(summary.trade.instructions[1].d_prime->value - summary.trade.instructions[0].d_prime->value));
  CHECK((*gap.estimate->p < 0.05) == (gap.estimate->interval.low > 0 || gap.estimate->interval.high < 0));
  CHECK(to_html(summary).find("Sensitivity d\u2032 over all levels") != std::string::npos);
  auto signalled = data;
  signalled.signalled = true;  // the lags are the macro trade then
  CHECK_FALSE(macro_figure(summarise(signalled)));
}

TEST_CASE("A difference that could not be estimated leaves the others under their own pairs of conditions",
          "[report]") {
  Summary summary;
  summary.data = head();
  summary.data.payoff = true;
  const char* names[] = {"fast", "even", "slow"};
  for (const auto* name : names) summary.trade.instructions.emplace_back().instruction = name;
  for (int a = 0; a < 3; ++a)
    for (int b = a + 1; b < 3; ++b)
      summary.trade.differences.push_back({names[a], names[b], "proportion correct", "proportion", {}});
  const analysis::Estimate points{7, {6, 8}};
  summary.trade.differences.push_back({"fast", "slow", "points a trial", "points", points});
  const Table* found = nullptr;
  const auto all = document(summary);
  for (const auto& part : all.parts)
    if (const auto* table = std::get_if<Table>(&part); table && table->columns.size() == 4) {
      if (said(table->columns[2].title) == "slow \u2212 fast") found = table;
    }
  REQUIRE(found);
  bool points_found = false;
  for (const auto& row : found->rows) {
    REQUIRE(row.size() == 4);
    if (said(row[0].text) != "Points a trial") continue;
    points_found = true;
    CHECK(row[1].kind == Cell::Kind::missing);
    CHECK(row[2].kind == Cell::Kind::number);
    CHECK(row[3].kind == Cell::Kind::missing);
  }
  CHECK(points_found);
}

TEST_CASE("Comparisons are corrected for their number only if the protocol asks for it", "[report]") {
  auto data = speed_accuracy(28);
  const auto plain = summarise(data);
  for (const auto& one : plain.trade.differences) CHECK_FALSE(one.corrected_p);
  CHECK(to_html(plain).find("Holm") == std::string::npos);
  data.holm = protocol::Holm::all;
  const auto all = summarise(data);
  double smallest = 1;
  int compared = 0;
  for (const auto& one : all.trade.differences)
    if (one.estimate) smallest = std::min(smallest, *one.estimate->p), ++compared;
  for (const auto& one : all.trade.differences) {
    REQUIRE(one.corrected_p.has_value() == one.estimate.has_value());
    if (!one.estimate) continue;
    CHECK(*one.corrected_p >= *one.estimate->p);
    if (*one.estimate->p == smallest) CHECK(*one.corrected_p == Approx(std::min(1.0, compared * smallest)));
  }
  CHECK(to_html(all).find("corrected by Holm\u2019s method for the number of all differences") !=
        std::string::npos);
  data.holm = protocol::Holm::measure;  // one pair of conditions: nothing to correct within a measure
  for (const auto& one : summarise(data).trade.differences)
    if (one.estimate) CHECK(*one.corrected_p == *one.estimate->p);
}

TEST_CASE("Degenerate sessions give statements instead of numbers", "[report]") {
  auto data = head();
  SECTION("nothing at all") {}
  SECTION("five trials, all right at one level") {
    for (int i = 0; i < 5; ++i) {
      analysis::TrialRecord trial;
      trial.trial_index = i;
      trial.level = -10;
      trial.response = trial.right_choice = i % 2;
      trial.correct = true;
      trial.response_time_s = 0.5;
      data.trials.push_back(trial);
    }
  }
  SECTION("timeouts only") {
    data.trials.resize(30);
    for (auto& trial : data.trials) trial.outcome = core::Outcome::timeout;
  }
  const auto summary = summarise(data);
  REQUIRE(summary.fits.size() == 1);
  CHECK_FALSE(summary.fits[0].fit.parameters.has_value());
  const auto html = to_html(summary), json = to_json(summary);
  CHECK(html.find("class=\"note\"") != std::string::npos);
  for (const auto* word : {"nan", "inf<", "NaN", ">none<"}) CHECK(html.find(word) == std::string::npos);
  const auto parsed = nlohmann::json::parse(json);
  CHECK(parsed["fits"][0]["threshold"].is_null());
  CHECK(parsed["fits"][0]["statements"].size() > 0);
}

TEST_CASE("The report draws the vibration of each trial only if a pick-up measured it", "[report]") {
  auto data = staircase_session();
  CHECK_FALSE(vibration_figure(summarise(data)).has_value());
  CHECK(to_html(summarise(data)).find("Vibration of the surface") == std::string::npos);
  data.measured = {{0, 0.1, true}, {1, -62, false}, {2, -0.2, true}};
  const auto summary = summarise(data);
  const auto figure = vibration_figure(summary);
  REQUIRE(figure);
  const auto& points = std::get<report::Points>(figure->charts.front().layers.back());
  CHECK(points.x == std::vector<double>{1, 2, 3});
  CHECK(points.y == std::vector<double>{0.1, -40, -0.2});
  CHECK(points.open == std::vector<bool>{false, true, false});
  CHECK(to_html(summary).find("Vibration of the surface") != std::string::npos);
  keep("vibration.svg", shown(figure));
}

TEST_CASE("A forced-choice session in dB has its threshold and 75 % point in the page", "[report]") {
  const auto summary = summarise(staircase_session());
  REQUIRE(summary.fits[0].fit.parameters);
  CHECK(summary.fits[0].fit.parameters->threshold == Approx(-19).margin(3));
  const auto html = to_html(summary);
  CHECK(html.find("75 % point") != std::string::npos);
  CHECK(html.find("parametric bootstraps") != std::string::npos);
  CHECK(html.find("credible") == std::string::npos);
  keep("forced.svg", shown(psychometric_figure(summary)));
  keep("staircase.svg", shown(trace_figure(summary)));
}

TEST_CASE("A participant of a group has the threshold of that condition", "[report]") {
  auto data = staircase_session();
  data.conditions = {"trained", "untrained"};
  for (auto& trial : data.trials) trial.instruction = "untrained";
  const auto fits = fits_of(data);
  REQUIRE(fits.size() == 1);
  CHECK(fits[0].name == "untrained");
  data.conditions = {"untrained"};
  CHECK(fits_of(data).at(0).name.empty());
}

TEST_CASE("If the answers determined the levels, the report states the posterior and its prior", "[report]") {
  auto data = staircase_session();
  data.prior = analysis::Prior{-40, 3, 0.25, 16, 0.25};
  const auto summary = summarise(data);
  const auto& found = summary.fits[0].intervals;
  REQUIRE((found.threshold && found.slope && found.interval_75));
  const auto html = to_html(summary);
  CHECK(html.find("central 95 % credible intervals of a posterior on a grid") != std::string::npos);
  CHECK(
      html.find(
          "threshold uniform from -29.2 to -7.75 dB, falling to 0 at -40 and 3; slope uniform in its "
          "logarithm from 0.707 to 5.66, falling to 0 at 0.25 and 16; lapse rate uniform from 0 to 0.06.") !=
      std::string::npos);
  CHECK(html.find("bootstrap") == std::string::npos);
  CHECK(html.find("Deviance") == std::string::npos);
  const auto fit = nlohmann::json::parse(to_json(summary))["fits"][0];
  CHECK(fit["prior"]["threshold"]["low"] == -29.25);
  CHECK(fit["prior"]["threshold"]["falls_to_0_at"][0] == -40);
  CHECK(fit["prior"]["slope"]["falls_to_0_at"][1] == 16);
  CHECK(fit["prior"]["slope"]["uniform_in"] == "logarithm");
  CHECK(fit["threshold_interval"]["low"] == found.threshold->interval.low);
  CHECK(fit["deviance"].is_null());
  const auto figure = psychometric_figure(summary);
  keep("posterior.svg", shown(figure));
  const auto& layers = figure->charts[0].layers;
  const double threshold = summary.fits[0].fit.parameters->threshold;
  CHECK(std::any_of(layers.begin(), layers.end(), [&](const auto& layer) {
    const auto* rule = std::get_if<report::Rule>(&layer);
    return rule != nullptr && rule->direction == report::Rule::Direction::vertical && rule->at == threshold &&
           rule->label == "threshold " + in_digits(threshold, &found.threshold->interval) + " dB (81.6 %)";
  }));
  CHECK(std::any_of(layers.begin(), layers.end(), [&](const auto& layer) {
    const auto* span = std::get_if<report::Span>(&layer);
    return span != nullptr && span->low == found.threshold->interval.low &&
           span->high == found.threshold->interval.high;
  }));
  data.trials.resize(20);
  const auto cut = summarise(data);
  CHECK_FALSE(cut.fits[0].intervals.slope);
  CHECK(to_html(cut).find("do not determine the slope") != std::string::npos);
  CHECK(nlohmann::json::parse(to_json(cut))["fits"][0]["slope"].is_null());
}

namespace {

/// Makes a session with two instructions and force cells. The finger meets the boundary 0.4 mm before its
/// planned place.
SessionData force_session() {
  auto data = speed_accuracy(6);
  data.conditions = {"speed", "accuracy"};
  core::Draws draws({5, core::Stream::observer, 0, 0, 0});
  for (const auto& trial : data.trials) {
    analysis::FingerTrial finger;
    finger.trial_index = trial.trial_index;
    finger.condition = trial.instruction;
    finger.measured = trial.trial_index % 17 != 16;
    const bool fast = trial.instruction == "speed";
    finger.planned_mm = 150 + 60 * *trial.level;
    if (finger.measured) {
      finger.normal_N = (fast ? 0.42 : 0.55) + 0.12 * (draws.uniform() - 0.5);
      finger.speed_mm_s = (fast ? 118 : 82) + 30 * (draws.uniform() - 0.5);
      if (trial.trial_index % 5 != 0) {
        finger.mu_low = 0.35 + 0.06 * draws.uniform();
        finger.mu_high = 0.75 + 0.1 * draws.uniform();
        finger.felt_mm = *finger.planned_mm - 0.4 + 2 * (draws.uniform() - 0.5);
        finger.felt_se_mm = 0.6;
      }
    }
    data.finger.push_back(finger);
  }
  return data;
}

}  // namespace

TEST_CASE("The report has the finger's force, speed and friction only if force cells recorded", "[report]") {
  const auto without = summarise(speed_accuracy(6));
  CHECK_FALSE(finger_figure(without));
  CHECK_FALSE(friction_figure(without));
  CHECK(to_html(without).find("The finger") == std::string::npos);
  CHECK(nlohmann::json::parse(to_json(without))["finger"].is_null());

  const auto summary = summarise(force_session());
  const auto forces = finger_figure(summary), friction = friction_figure(summary);
  REQUIRE((forces && friction));
  REQUIRE(forces->charts.size() == 2);
  const auto& accuracy = std::get<report::Points>(forces->charts[0].layers[1]);
  CHECK(accuracy.name == "accuracy");
  // the figure has at most 40 markers, so with 72 trials each marker is the mean of two
  const double one = *summary.data.finger[36].normal_N, two = *summary.data.finger[37].normal_N;
  CHECK(accuracy.y.front() == Approx((one + two) / 2));
  CHECK(accuracy.high.front() == std::max(one, two));
  CHECK(accuracy.low.front() == std::min(one, two));
  CHECK(accuracy.x.front() == 37.5);
  const auto& shifts = std::get<report::Points>(friction->charts[0].layers.back());
  CHECK(shifts.x == std::vector<double>{126, 138, 144, 156, 162, 174});
  CHECK(shifts.low.front() < shifts.y.front());
  CHECK(std::get<report::Points>(friction->charts[1].layers[1]).name == "rough side");
  const auto html = to_html(summary);
  CHECK(html.find("<h2>The finger</h2>") != std::string::npos);
  CHECK(html.find("Felt minus planned boundary (mm)") != std::string::npos);
  const auto json = nlohmann::json::parse(to_json(summary))["finger"];
  REQUIRE(json["conditions"].size() == 2);
  CHECK(json["conditions"][0]["speed_mm_s"]["value"].get<double>() == Approx(118).margin(5));
  CHECK(json["conditions"][1]["felt_minus_planned_mm"]["value"].get<double>() == Approx(-0.4).margin(0.5));
  CHECK(json["felt_minus_planned_mm"].size() == 6);
  keep("finger.svg", shown(forces));
  keep("friction.svg", shown(friction));
  keep("finger.html", html);
  auto apart = force_session();
  for (auto& trial : apart.finger) {
    trial.condition = "speed";
    trial.trial_index += trial.trial_index < 35 ? 0 : 100;  // an odd number of trials, then another block
  }
  const auto two_blocks = finger_figure(summarise(apart));
  const auto& means = std::get<report::Points>(two_blocks->charts[0].layers[0]);
  for (const double x : means.x) CHECK((x <= 35 || x >= 136));

  auto few = force_session();
  few.finger.resize(12);
  few.finger[11].trial_index = 30;
  const auto each = finger_figure(summarise(few));
  const auto& singles = std::get<report::Points>(each->charts[0].layers[0]);
  CHECK(singles.x.size() == 12);
  CHECK(singles.x.back() == 31);
  CHECK(singles.high == singles.y);
  keep("friction-few.svg", shown(friction_figure(summarise(few))));
  for (auto& trial : few.finger) trial.felt_mm.reset();
  const auto unfelt = to_html(summarise(few));
  CHECK(unfelt.find("In no trial did the finger cross a clear step") != std::string::npos);
  CHECK(unfelt.find("Friction along the strip") == std::string::npos);
}

TEST_CASE("Friction over place has the medians of intervals, each of which counts once in a place",
          "[report]") {
  auto data = speed_accuracy(6);
  CHECK(summarise(data).followed.empty());
  CHECK(to_html(summarise(data)).find("Friction that follows the finger") == std::string::npos);
  // Four intervals of one scene: felt friction is 10, 20, 30 and 80 % above the asked one, and the slowest
  // finger has a hundred points in a place. Only two of them are at 61.5 mm.
  std::vector<analysis::FollowedPath> paths;
  for (const auto& [share, points] : {std::pair(1.1, 100), {1.2, 1}, {1.3, 5}, {1.8, 2}}) {
    auto& path = paths.emplace_back(analysis::FollowedPath{"", "grating", {}});
    for (int k = 0; k < points; ++k) path.points.push_back({60.2, false, 0.5, 0.4, 0.5 * share});
    path.points.push_back({62.7, true, 0.6, 0.6, 0.6 * share});
    if (share > 1.25) path.points.push_back({61.5, false, 0.5, 0.4, 0.5});
  }
  data.followed_places = analysis::friction_over_place(paths);
  REQUIRE(data.followed_places.size() == 2);
  const auto &narrow = data.followed_places[0], &wide = data.followed_places[1];
  CHECK(narrow.narrow);
  CHECK(narrow.place_mm == std::vector{62.5});
  CHECK(wide.place_mm == std::vector{60.5});  // two intervals are too few
  CHECK(wide.felt[0].median == Approx(0.625));
  CHECK(wide.felt[0].low == Approx(0.5 * 1.175));
  CHECK(wide.commanded[0].median == Approx(0.4));
  CHECK(wide.deviation[0].median == Approx(0.25));
  CHECK(wide.deviation[0].high == Approx(0.425));
  for (int k = 0; k < 4; ++k) {
    core::FollowRow row;
    row.followed = k < 3 ? "ok" : "lifted";
    row.mu_asked = 0.5 + 0.01 * k, row.mu_felt = 0.6, row.share = 1.0;
    if (k < 2) row.lag_ms = 3;
    data.followed.push_back({k, "", row});
  }
  const auto summary = summarise(data);
  REQUIRE(summary.followed.size() == 1);
  CHECK(summary.followed[0].trials == 4);
  CHECK(summary.followed[0].faultless == 3);
  CHECK(summary.followed[0].mu_asked->value == Approx(0.515));
  CHECK_FALSE(summary.followed[0].lag_ms);  // of two trials
  CHECK_FALSE(asked_differs(summary));
  CHECK(followed_figure(summary)->charts.size() == 2);
  CHECK(deviation_figure(summary)->charts.size() == 1);
  const auto html = to_html(summary);
  CHECK(html.find("Friction that follows the finger") != std::string::npos);
  CHECK(html.find("is not drawn") == std::string::npos);
  data.followed_places.clear();
  const auto pressed = to_html(summarise(data));
  CHECK(pressed.find("A finger that presses without sliding feels no friction") != std::string::npos);
  CHECK_FALSE(followed_figure(summarise(data)));
  paths[0].points[0].asked = 30, paths[1].points[0].asked = 0.8, paths[2].points[0].asked = 1.5;
  data.followed_places = analysis::friction_over_place(paths);
  CHECK(asked_differs(summarise(data)));
}

TEST_CASE("The label of a threshold has the digits of the table, and the criterion that the protocol says",
          "[report]") {
  const auto summary = summarise(speed_accuracy(28));
  const auto svg = render(*psychometric_figure(summary));
  const auto html = to_html(summary);
  for (const auto& named : summary.fits) {
    REQUIRE(named.intervals.threshold);
    const auto digits = in_digits(named.fit.parameters->threshold, &named.intervals.threshold->interval);
    CHECK(html.find(digits + " <span class=\"soft\">[") != std::string::npos);
    CHECK(svg.find(named.name + ": PSE " + digits) != std::string::npos);
    CHECK(svg.find("(50 %)") != std::string::npos);
  }
  for (const auto& [name, said] :
       {std::pair{"friction-2ifc", "81.6 %"}, {"friction-3ifc", "75.5 %"}, {"boundary-constant", "50 %"}}) {
    const auto data = data_of(shipped(name));
    INFO(name << ": " << data.meaning);
    if (data.design == Design::forced_choice)
      CHECK(data.meaning.find(std::string(said) + " correct") != std::string::npos);
    CHECK(shown(psychometric_figure(summarise(data))).find("(" + std::string(said) + ")") !=
          std::string::npos);
  }
}

TEST_CASE(
    "Every figure of a report has a caption with the study, the participant, the trials and the kind of each "
    "interval, which does not repeat its title",
    "[report]") {
  for (const char* name :
       {"friction-2ifc", "speed-accuracy", "response-signal", "friction-rating", "friction-yes-no",
        "friction-boundary-2d", "boundary-constant", "boundary-adjustment", "friction-pairs"}) {
    auto data = data_of(shipped(name));
    data.title = "Study of friction", data.participant = "P07";
    const auto figures = figures_of(document(summarise(data)));
    CHECK(!figures.empty());
    for (const auto& [file, figure] : figures) {
      INFO(name << ", " << file << ": " << figure.caption);
      CHECK(figure.caption.starts_with("Study of friction. Participant P07, "));
      CHECK(figure.caption.find(" trials.") != std::string::npos);
      CHECK(figure.caption.find(" 0 trials") == std::string::npos);
      CHECK(figure.caption.find(figure.title) == std::string::npos);
      bool intervals = false;
      for (const auto& chart : figure.charts) {
        CHECK(chart.title != "all trials");
        CHECK((chart.x.label + chart.y.label).find("no unit") == std::string::npos);
        for (const auto& layer : chart.layers) {
          if (const auto* dots = std::get_if<Points>(&layer)) intervals = intervals || !dots->low.empty();
          intervals = intervals || std::holds_alternative<Band>(layer) || std::holds_alternative<Span>(layer);
        }
      }
      if (!intervals) continue;
      const char* const kinds[] = {"Wilson",    "Student",  "Gourevitch",     "likelihood",
                                   "posterior", "credible", "order statistic"};
      CHECK(std::any_of(std::begin(kinds), std::end(kinds), [&figure = figure](const char* kind) {
        return figure.caption.find(kind) != std::string::npos;
      }));
    }
  }
}

TEST_CASE("The caption says if markers are drawn beside each other", "[report]") {
  for (const auto& [name, figure] : figures_of(document(summarise(speed_accuracy(28))))) {
    INFO(name);
    CHECK((figure.caption.find("side by side") != std::string::npos) == has_moved(figure));
  }
}

TEST_CASE("Two conditions stand in one chart, and each of more in a chart of its own", "[report]") {
  auto data = speed_accuracy(28);
  CHECK(psychometric_figure(summarise(data))->charts.size() == 1);
  for (auto& trial : data.trials)
    if (trial.trial_index % 3 == 0) trial.instruction = "neither";
  const auto figure = *psychometric_figure(summarise(data));
  REQUIRE(figure.charts.size() == 3);
  for (const auto& chart : figure.charts) {
    CHECK(!chart.title.empty());
    CHECK(chart.x == figure.charts[0].x);
    CHECK(chart.y == figure.charts[0].y);
  }
  // three charts fill a row of two columns
  for (const auto& [name, every] : figures_of(document(summarise(data))))
    if (every.charts.size() == 3) {
      INFO(name);
      CHECK(for_paper(every, kTwoColumns_mm).columns == 3);
    }
  // a whole figure in one column, with a legend or labels, is mostly data
  CHECK(least_data_px(for_paper(figure, kOneColumn_mm)) >
        0.45 * for_paper(figure, kOneColumn_mm).chart_width_px);
}

TEST_CASE("The quantiles of response times are named in a legend, and stand at their probability",
          "[report]") {
  const auto figure = quantile_probability_figure(summarise(speed_accuracy(28)));
  const auto svg = shown(figure);
  for (const char* name : {"0.1", "0.3", "0.5", "0.7", "0.9"})
    CHECK(svg.find(">quantile " + std::string(name) + "</text>") != std::string::npos);
  CHECK(!has_moved(*figure));
}

TEST_CASE("A number of a report has the digits that its interval determines, and says what is not determined",
          "[report]") {
  const auto shown = [](const Number& number, const char* language = "en") {
    const auto [value, interval] = in_known_digits(number);
    return core::say(value, language) + " " + core::say(interval, language);
  };
  const double endless = std::numeric_limits<double>::infinity();
  CHECK(shown({-0.51234}) == "\u22120.512 ");
  CHECK(shown({-0.51234, analysis::Interval{-0.71, -0.31}}) == "\u22120.512 [\u22120.710, \u22120.310]");
  CHECK(shown({2, analysis::Interval{1, 3}, 3, true, true}) == "2.00 [\u2264 1.00, \u2265 3.00]");
  CHECK(shown({2, analysis::Interval{1, endless}}) == "2.00 [1.00, not determined]");
  CHECK(shown({2, analysis::Interval{1, endless}}, "de") == "2.00 [1.00, nicht bestimmt]");
  CHECK(shown({2, analysis::Interval{1, endless}, 3, false, false, true}) == "2 [1, \u221e]");
}

TEST_CASE("A curve ends where its band ends, and is thin and dashed beyond the levels presented",
          "[report]") {
  const auto summary = summarise(speed_accuracy(28));
  const auto figure = *psychometric_figure(summary);
  CHECK(figure.caption.find("Thin and dashed") != std::string::npos);
  for (const auto& chart : figure.charts)
    for (const auto& other : chart.layers)
      if (const auto* band = std::get_if<Band>(&other)) {
        double low = INFINITY, high = -INFINITY;
        for (const auto& layer : chart.layers)
          if (const auto* line = std::get_if<Line>(&layer); line != nullptr && line->series == band->series) {
            low = std::min(low, line->x.front()), high = std::max(high, line->x.back());
            if (line->beyond)
              CHECK((line->x.back() <= -0.4 + 1e-9 || line->x.front() >= 0.4 - 1e-9));
            else
              CHECK((line->x.front() == Approx(-0.4) && line->x.back() == Approx(0.4)));
          }
        CHECK(low == Approx(band->x.front()));
        CHECK(high == Approx(band->x.back()));
      }
}
