#include "station/report/stored_trials.hpp"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "station/core/toml.hpp"
#include "station/protocol/conditions.hpp"
#include "station/report/document.hpp"
#include "tests/report/simulated_report.hpp"
#include "tests/support/catch.hpp"

// Tests how a protocol file and its stored rows become a report.

using namespace turnpoint;

namespace {

/// A yes/no protocol with a change of friction in half of the trials; `sign` -1 makes the change a decrease.
std::string yes_no(const std::string& analysis, int sign = 1, int repeats = 40) {
  auto source = shipped("speed-accuracy");
  source.erase(source.find("[[sequence]]"));
  source.erase(source.find("[instructions.speed]"));
  const auto list = sign > 0 ? "[0.0, 0.0, 0.0, 0.05, 0.1, 0.3]" : "[0.0, 0.0, 0.0, -0.05, -0.1, -0.3]";
  source = replaced(source, "values = [-0.4, -0.2, -0.1, 0.1, 0.2, 0.4]", std::string("values = ") + list);
  source = replaced(source, "repeats = 14", "repeats = " + std::to_string(repeats));
  source = replaced(source, "range = [-0.4, 0.4]", sign > 0 ? "range = [0.0, 0.4]" : "range = [-0.4, 0.0]");
  source = replaced(source, "smoother = \"change < 0\", rougher = \"change > 0\"",
                    sign > 0 ? "smoother = \"change == 0\", rougher = \"change > 0\""
                             : "smoother = \"change < 0\", rougher = \"change == 0\"");
  source = replaced(source, "explore_s = 5.0", "explore_s = 5.0\ndeadline_s = 4.0");
  const auto factor = source.find("[[factor]]\nname = \"instruction\"");
  source.erase(factor, source.find("[scene.before]") - factor);
  return source + "\n[[block]]\nname = \"main\"\nprocedures = [\"levels\"]\n\n" + analysis;
}

}  // namespace

TEST_CASE("a numeric factor gives one curve for each level, two factors give one for each combination",
          "[report]") {
  auto source = replaced(shipped("demo"), "repeats = 2", "repeats = 12") + "\n[analysis]\n";
  const auto pooled = data_of(source);
  CHECK(pooled.conditions.empty());
  CHECK(report_of(pooled)["fits"].size() == 1);
  const auto by_mark = report_of(data_of(source + "by = \"mark_mm\"\n"));
  REQUIRE(by_mark["fits"].size() == 2);
  CHECK(by_mark["fits"][0]["name"] == "mark 150 mm");
  CHECK(by_mark["fits"][1]["name"] == "mark 160 mm");
  CHECK(by_mark["differences"][0]["first"] == "mark 150 mm");
  const auto finger = replaced(source, "[scene.edge]",
                               "[[factor]]\nname = \"finger\"\nlevels = [\"wet\", \"dry\"]\n\n[scene.edge]");
  const auto both = data_of(finger + "by = [\"finger\", \"mark_mm\"]\n");
  CHECK(both.conditions == std::vector<std::string>{"wet, mark 150 mm", "wet, mark 160 mm",
                                                    "dry, mark 150 mm", "dry, mark 160 mm"});
  CHECK(report_of(both)["fits"].size() == 4);
}

TEST_CASE("settings are grouped by the levels of a factor", "[report]") {
  const auto source = shipped("boundary-adjustment");
  REQUIRE(source.find("mark_mm") != std::string::npos);
  const auto settings = report_of(data_of(source + "\n[analysis]\nby = \"mark_mm\"\n"))["settings"];
  CHECK(settings.size() > 1);
  CHECK(settings[0]["condition"].get<std::string>().find("mark ") == 0);
}

TEST_CASE("conditions are in the order of the file, whichever block came first", "[report]") {
  const auto first = report_of(data_of(shipped("speed-accuracy"), "sim", 0));
  const auto second = report_of(data_of(shipped("speed-accuracy"), "sim", 1));
  const auto began = [](int index) {
    return data_of(shipped("speed-accuracy"), "sim", index).trials.back().instruction;
  };
  CHECK(began(0) != began(1));  // the order of conditions differs between the two sessions
  for (const auto& report : {first, second}) {
    REQUIRE(report["instructions"].size() == 2);
    CHECK(report["instructions"][0]["instruction"] == "speed");
    CHECK(report["differences"][0]["first"] == "speed");
    CHECK(report["differences"][0]["second"] == "accuracy");
  }
}

TEST_CASE("if the key by names another factor, the instructions are pooled", "[report]") {
  auto source = replaced(shipped("speed-accuracy"), "by = \"instruction\"", "by = \"finger\"");
  source = replaced(source, "[scene.before]",
                    "[[factor]]\nname = \"finger\"\nlevels = [\"wet\", \"dry\"]\n\n[scene.before]");
  const auto report = report_of(data_of(source));
  REQUIRE(report["instructions"].size() == 2);
  CHECK(report["instructions"][0]["instruction"] == "wet");
}

TEST_CASE("yes/no is analysed as yes/no", "[report]") {
  // d' is proportional to the change, with 1.349 at a change of .1; the rate of false alarms is 15 %.
  const auto* observer = "sim:threshold=0.1,lapse=0,criterion=1.036";
  for (const int sign : {1, -1}) {
    const auto data = data_of(yes_no("", sign, 120), observer);
    CHECK(data.design == report::Design::yes_no);
    CHECK(data.positive == (sign > 0 ? 1 : 0));
    const auto report = report_of(data);
    REQUIRE(report["detection"].size() == 4);
    CHECK(report["detection"][1]["level"] == 0.1);
    CHECK(report["detection"][1]["d_prime"]["value"].get<double>() == Approx(1.349).margin(0.45));
    CHECK(report["detection"][1]["criterion"]["value"].get<double>() == Approx(1.036 - 0.6745).margin(0.25));
    const auto& fit = report["fits"][0];
    CHECK(fit["guess"].get<double>() == Approx(0.15).margin(0.05));
    CHECK(fit["threshold"].is_number());
    CHECK(fit["positive"].get<std::string>() == (sign > 0 ? "\u201crougher\u201d" : "\u201csmoother\u201d"));
    const auto html = report::to_html(report::summarise(data));
    CHECK(html.find("Sensitivity and criterion") != std::string::npos);
    CHECK(html.find("reversed") == std::string::npos);
    CHECK(html.find("inf") == std::string::npos);
  }
}

TEST_CASE("yes/no with confidence has the ROC of these ratings, and its area follows from d'", "[report]") {
  const auto text = [](const std::string& word) {
    return "{ en = \"" + word + "\", de = \"" + word + "\" }";
  };
  const auto confident =
      replaced(replaced(yes_no("", 1, 120), "device = \"buttons\"", "device = \"touch\""), "[timing]",
               "[task.confidence]\nquestion = " + text("Sure?") + "\nlabels = [" + text("no") + ", " +
                   text("fairly") + ", " + text("yes") + "]\n\n[timing]");
  const auto data = data_of(confident, "sim:threshold=0.1,lapse=0,criterion=0.6745");
  const auto report = report_of(data);
  REQUIRE(report["roc"].size() == 4);
  CHECK(report["roc"][1]["level"] == 0.1);
  CHECK(report["roc"][1]["points"].size() == 7);
  // d' is 1.349 at this level. The area under the whole curve is Phi(1.349 / sqrt 2) = 0.830; with few
  // ratings it is slightly smaller.
  CHECK(report["roc"][1]["area"]["value"].get<double>() == Approx(0.815).margin(0.06));
  CHECK(report["roc"][3]["level"].is_null());
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("Receiver operating characteristic") != std::string::npos);
  CHECK(report_of(data_of(yes_no("", 1, 10)))["roc"].empty());
  CHECK(report_of(data_of(shipped("friction-confidence")))["roc"].empty());  // no trial without a signal
}

TEST_CASE("one rating of how sure a person is of a signal has a ROC, d' and d_a", "[report]") {
  auto source = shipped("friction-detection");
  const auto choices = source.find("choices = [");
  const auto confidence = source.find("[task.confidence]"), timing = source.find("[timing]");
  source.replace(confidence, timing - confidence,
                 "[task.rating]\npoints = 6\nlabels = [{ at = 1, text = { en = \"surely not\", de = \"sicher "
                 "nicht\" } }, { at = 6, text = { en = \"surely\", de = \"sicher\" } }]\n\n");
  source.replace(choices, confidence - choices, "present = \"step > 0\"\n\n");
  source = replaced(replaced(source, "feedback = \"trial\"\n", ""), "repeats = 20", "repeats = 200");
  source = replaced(source, "\"psychometric\", ", "");
  const auto data = data_of(source, "sim:threshold=0.08,lapse=0");
  CHECK(data.design == report::Design::ratings);
  const auto report = report_of(data);
  REQUIRE(report["roc"].size() == 4);
  const auto& curve = report["roc"][1];  // d' is 1.349 at the threshold
  CHECK(curve["level"] == 0.08);
  CHECK(curve["points"].size() == 7);
  CHECK(curve["equal_variances"]["sensitivity"]["value"].get<double>() == Approx(1.349).margin(0.15));
  CHECK(curve["equal_variances"]["criteria"].size() == 5);
  CHECK(curve["unequal_variances"]["sensitivity"]["value"].get<double>() == Approx(1.349).margin(0.2));
  CHECK(curve["unequal_variances"]["sd"]["value"].get<double>() == Approx(1).margin(0.2));
  CHECK(curve["area"]["value"].get<double>() == Approx(0.82).margin(0.04));
  CHECK(report["roc"][0]["area"]["value"].get<double>() < curve["area"]["value"].get<double>());
  CHECK(report["judgements"].size() == 1);  // the mean ratings are still there
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("Receiver operating characteristic") != std::string::npos);
  CHECK(html.find("Ratings go from the surest no") != std::string::npos);
  auto hidden = replaced(source, "show = [\"dprime\"]", "show = [\"trace\"]");
  CHECK(report_of(data_of(hidden))["roc"].empty());
  CHECK(report_of(data_of(shipped("smoothness-points")))["roc"].empty());  // no signal is declared
}

TEST_CASE("same-different counts pairs that are the same as false alarms", "[report]") {
  const auto data = data_of(shipped("friction-same-different"), "sim:threshold=-14,lapse=0");
  const auto report = report_of(data);
  CHECK(report["fits"][0]["levels"][0]["level"].is_null());
  CHECK(report["fits"][0]["guess"].get<double>() == Approx(0.25).margin(0.12));
}

TEST_CASE("The trial before of same-different has stimulus 0 where nothing differed, and names its answer",
          "[report]") {
  auto data = data_of(shipped("friction-same-different"), "sim:threshold=-14,lapse=0");
  const auto before = report_of(data)["trial_before"][0];
  CHECK(before["answer"] == "different");
  CHECK(before["model"] == "choices");
  CHECK(before["level_unit"] == "dB");
  CHECK(before["ratios"] == true);
  REQUIRE_FALSE(before["stimulus"].is_null());
  CHECK(before["stimulus"]["interval"]["low"] > 0);
  const auto page = report::to_html(report::summarise(data));
  CHECK(page.find("log odds of the answer \u201cdifferent\u201d. A stimulus counts as a ratio (1 for 0 dB), "
                  "and is 0") != std::string::npos);
  for (auto& trial : data.trials)
    if (trial.right_choice == 1 - data.positive) trial.level = 12;
  CHECK(report_of(data)["trial_before"][0] == before);
}

TEST_CASE("each value of the key show adds a part to the report", "[report]") {
  const auto source = [](const std::string& show) {
    return replaced(shipped("speed-accuracy"),
                    "show = [\"psychometric\", \"ez\", \"bis\", \"lisas\", \"caf\"]",
                    "show = [" + show + "]");
  };
  const auto none = data_of(source(""), "sim:threshold=0.2");
  struct Part {
    const char *word, *mark;
  };
  const Part parts[] = {{"psychometric", "Psychometric function"},
                        {"ez", "Boundary a (diffusion"},
                        {"bis", "balanced integration score (BIS)"},
                        {"lisas", "LISAS"},
                        {"ies", "Inverse efficiency"},
                        {"caf", "Conditional accuracy"},
                        {"dprime", "Sensitivity and criterion"},
                        {"trace", "Levels in the order presented"}};
  const auto page = [](const report::SessionData& data) { return report::to_html(report::summarise(data)); };
  const auto bare = page(none), bare_json = report::to_json(report::summarise(none));
  CHECK(bare.find("Proportion correct") != std::string::npos);
  for (const auto& part : parts) {
    INFO(part.word);
    CHECK(bare.find(part.mark) == std::string::npos);
    auto data = none;
    data.show = {part.word};
    const auto html = page(data);
    CHECK(html.find(part.mark) != std::string::npos);
    for (const auto& other : parts)
      if (&other != &part) CHECK(html.find(other.mark) == std::string::npos);
    // of "bis", a session has only the sentence that says where the score is
    if (std::string(part.word) != "trace" && std::string(part.word) != "bis")
      CHECK(report::to_json(report::summarise(data)) != bare_json);
  }
}

TEST_CASE("ratings and numbers are reported by level, and right and wrong are left out", "[report]") {
  const auto line = report_of(data_of(shipped("smoothness-line")));
  REQUIRE(line["judgements"].size() == 1);
  REQUIRE(line["judgements"][0]["levels"].size() == 5);
  CHECK(line["judgements"][0]["levels"][0]["answers"] == 8);  // practice trials are not counted
  CHECK(line["judgements"][0]["levels"][4]["mean"]["value"] >
        line["judgements"][0]["levels"][0]["mean"]["value"]);
  CHECK(line["judgements"][0]["exponent"].is_null());
  CHECK(line["fits"].empty());
  CHECK(line["bias"].is_null());
  const auto numbers = data_of(shipped("magnitude-standard"), "sim:slope=0.7,lapse=0");
  CHECK(report_of(numbers)["judgements"][0]["exponent"]["value"].get<double>() == Approx(0.7).margin(0.12));
  const auto html = report::to_html(report::summarise(numbers));
  CHECK(html.find("Geometric mean") != std::string::npos);
  CHECK(html.find("Exponent of Stevens") != std::string::npos);
  CHECK(html.find("Proportion correct") == std::string::npos);
  CHECK(html.find("Trend of accuracy") == std::string::npos);
}

TEST_CASE("identification is reported as a confusion matrix, without a curve and without d'", "[report]") {
  const auto data = data_of(shipped("friction-identification"), "sim:lapse=0");
  const auto report = report_of(data);
  REQUIRE(report["confusion"].size() == 1);
  const auto& rows = report["confusion"][0]["rows"];
  REQUIRE(rows.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(rows[i]["stimulus"] == std::to_string(i + 1));
    CHECK(rows[i]["trials"] == 15);  // practice trials are not counted
    CHECK(rows[i]["answers"][i] == rows[i]["correct"]["right"]);
  }
  CHECK(report["confusion"][0]["correct"]["trials"] == 75);
  CHECK(report["fits"].empty());
  CHECK(report["bias"].is_null());
  CHECK(report["detection"].empty());
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("Answers to each stimulus") != std::string::npos);
  CHECK(html.find("Boundary a (diffusion") == std::string::npos);
  CHECK(report_of(data_of(shipped("friction-2ifc")))["confusion"].empty());
  CHECK(report_of(data_of(shipped("two-spots-oddity")))["confusion"][0]["rows"].size() == 3);
}

TEST_CASE("d' of three intervals and of ABX is reported by model, and the guess rate is known", "[report]") {
  const auto three = report_of(data_of(shipped("friction-3ifc"), "sim:lapse=0"));
  CHECK(three["fits"][0]["guess"].get<double>() == Approx(1.0 / 3));
  REQUIRE(three["discrimination"].size() == 1);  // one row for all adaptive levels together
  CHECK(three["discrimination"][0]["d_prime"][0]["model"] == "largest of m");
  CHECK(three["confusion"][0]["rows"].size() == 3);
  CHECK(three["detection"].empty());
  const auto data = data_of(shipped("friction-abx"), "sim:threshold=-20,slope=2,lapse=0");
  const auto abx = report_of(data);
  CHECK(abx["fits"][0]["guess"].get<double>() == Approx(0.5));
  REQUIRE(abx["discrimination"].size() == 5);
  REQUIRE(abx["discrimination"][3]["d_prime"].size() == 2);
  CHECK(abx["discrimination"][3]["level"] == -5.0);
  CHECK(abx["discrimination"][3]["correct"]["proportion"] == 1.0);
  CHECK(
      abx["discrimination"][3]["d_prime"][1]["interval"]["high"].is_null());  // the interval has no upper end
  CHECK(abx["confusion"].empty());
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("differencing") != std::string::npos);
  CHECK(html.find("\u221e") != std::string::npos);
}

TEST_CASE("the report counts right answers for each degree of confidence", "[report]") {
  const auto report = report_of(data_of(shipped("friction-confidence"), "sim:lapse=0"));
  REQUIRE(report["confidence"].size() >= 3);
  int trials = 0;
  for (const auto& degree : report["confidence"]) trials += degree["trials"].get<int>();
  CHECK(trials == 60);
  CHECK(report["confidence"].back()["proportion"] > report["confidence"].front()["proportion"]);
  CHECK(report_of(data_of(shipped("friction-2ifc")))["confidence"].empty());
}

TEST_CASE("what force cells measured is taken from answered trials, with their condition", "[report]") {
  const auto protocol = protocol::parse(shipped("speed-accuracy"), "p.toml");
  auto rehearsal = rehearsal::rehearse(protocol, 0, 5,
                                       rehearsal::rehearser(simulation::Observer(simulation::parse("sim"))));
  report::SessionData none;
  report::add_trials(rehearsal.blocks, protocol, none);
  CHECK(none.finger.empty());
  std::size_t expected = 0;
  for (auto& block : rehearsal.blocks)
    for (auto& row : block.trials) {
      row.finger.sensing = row.trial_index % 2 != 0 ? "wire" : row.trial_index % 4 == 0 ? "ok" : "slow";
      if (row.finger.sensing != "wire") row.finger.normal_N = 0.5, row.finger.contact_s = 2;
      row.presented.boundary_mm = 150;
      row.finger.boundary_felt_mm = 151.5;
      expected += !block.start.practice && row.outcome == core::Outcome::answered ? 1 : 0;
    }
  report::SessionData data;
  report::add_trials(rehearsal.blocks, protocol, data);
  REQUIRE(data.finger.size() == expected);
  REQUIRE(expected > 20);
  for (const auto& trial : data.finger) {
    CHECK(trial.measured == (trial.trial_index % 2 == 0));
    CHECK(trial.normal_N.has_value() == trial.measured);
    CHECK((trial.condition == "speed" || trial.condition == "accuracy"));
    CHECK(*trial.felt_mm - *trial.planned_mm == 1.5);
  }
}

TEST_CASE("settings are reported by the side from which the slider started", "[report]") {
  const auto sides = [](const std::string& source) {
    const auto json = report_of(data_of(source, "sim:threshold=4,bias=3"));
    return json["settings"][0];
  };
  const auto shipped_file = shipped("boundary-adjustment");
  const auto settings = sides(shipped_file);
  CHECK(settings["from_below"]["settings"] == 9);
  CHECK(settings["from_above"]["settings"] == 9);
  const double below = settings["from_below"]["mean"]["value"],
               above = settings["from_above"]["mean"]["value"];
  CHECK(settings["mean"]["value"].get<double>() == Approx(0.5 * (below + above)));
  CHECK(settings["side_difference"]["value"].get<double>() == Approx(below - above));
  // a single list of starting values is divided in the same way into starts below and above
  const auto list = replaced(shipped_file, "start_below = [-20.0]", "start = [-20.0, 20.0]");
  CHECK(sides(replaced(list, "start_above", "# start_above")) == settings);
  const auto one = replaced(shipped_file, "start_below = [-20.0]", "start = [-20.0]");
  CHECK(sides(replaced(one, "start_above", "# start_above"))["from_below"]["settings"] == 0);
  const auto html = report::to_html(report::summarise(data_of(shipped_file)));
  CHECK(html.find("from below (9 settings)") != std::string::npos);
}

namespace {

/// Answers every trial by a rule, as a person does who is always right, always wrong, presses one key or
/// none.
report::SessionData answered_by(
    const std::string& source, const std::function<std::optional<int>(const simulation::Question&)>& choice) {
  const auto protocol = protocol::parse(source, "p.toml");
  auto sits = rehearsal::rehearser(simulation::Observer(simulation::parse("sim:lapse=0")));
  sits.answer = [&](const trial::TrialSpec&, const simulation::Question& question) {
    simulation::Reply reply;
    reply.choice = choice(question);
    reply.response_time_s = reply.choice ? 0.6 : 100;
    return reply;
  };
  const auto rehearsal = rehearsal::rehearse(protocol, 0, 5, sits);
  report::SessionData data;
  report::add_trials(rehearsal.blocks, protocol, data);
  report::add_estimates(rehearsal.blocks, protocol, 5, {}, data);
  data.replicates = 40;
  return data;
}

}  // namespace

TEST_CASE("the function does not depend on the trials that a participant got", "[report]") {
  // practice at level 0 turned the Weibull function on a log axis into a normal one for those who drew it
  const auto source =
      replaced(shipped("speed-accuracy"), "correct = { smoother = \"change < 0\", rougher = \"change > 0\" }",
               "correct = { smoother = \"change < 0\", rougher = \"change >= 0\" }");
  const auto data = data_of(source);
  auto other = data;
  const auto before = report::fits_of(data).front().fit.options;
  other.trials.resize(other.trials.size() / 2);
  for (auto& trial : other.trials)
    if (trial.level) trial.level = std::fabs(*trial.level) + 0.1;
  const auto after = report::fits_of(other).front().fit.options;
  CHECK(before.function == after.function);
  CHECK(before.scale == after.scale);
  CHECK(before.guess == after.guess);
}

TEST_CASE("levels of 0 on a log axis tell the guess rate and do not stop the report", "[report]") {
  report::SessionData data = data_of(shipped("friction-2ifc"), "sim:lapse=0");
  data.scale = analysis::Scale::log10;
  data.function = core::Function::weibull;
  data.prior.reset();
  int number = 0;
  for (auto& trial : data.trials)
    if (trial.level) trial.level = 0.1 * (number++ % 5);
  const auto fits = report::fits_of(data);
  REQUIRE(fits.size() == 1);
  CHECK(fits[0].fit.data.front().level == analysis::kNoise);
  CHECK_NOTHROW(report::to_html(report::summarise(data)));
  for (auto& trial : data.trials) trial.level = 0;  // a staircase that never left the floor
  CHECK_NOTHROW(report::to_html(report::summarise(data)));
}

TEST_CASE("a bisection has the PSE at the cut and the spread of the observer", "[report]") {
  auto source = shipped("demo");
  source = replaced(source, "range = [-24.0, 24.0]", "range = [0.0, 40.0]");
  source = replaced(source, "left = \"offset_mm < 0\"", "left = \"offset_mm < 20\"");
  source = replaced(source, "right = \"offset_mm > 0\"", "right = \"offset_mm > 20\"");
  source = replaced(source, "values = [-24.0, -12.0, 0.0, 12.0, 24.0]",
                    "values = [5.0, 12.0, 17.0, 20.0, 23.0, 28.0, 35.0]");
  source = replaced(source, "repeats = 2", "repeats = 60");
  const auto data = data_of(source, "sim:threshold=4,bias=1,lapse=0");
  CHECK(data.design == report::Design::two_sided);
  const auto report = report_of(data);
  CHECK(report["fits"][0]["threshold"].get<double>() == Approx(21).margin(0.9));
  CHECK(report["fits"][0]["slope"].get<double>() == Approx(4 / 0.6745).margin(1.2));
  CHECK(report["measures"][0]["measures"] == "PSE and spread of `offset_mm` around 20, cumulative normal");
  CHECK(report::to_html(report::summarise(data)).find("around 20") != std::string::npos);
}

TEST_CASE("two answers of which none is right are fitted", "[report]") {
  auto source = replaced(shipped("demo"), "[task.correct]\nleft = \"offset_mm < 0\"", "");
  source = replaced(source, "right = \"offset_mm > 0\"", "");
  source = replaced(source, "feedback = \"trial\"", "");
  source = replaced(source, "repeats = 2", "repeats = 40");
  const auto report = report_of(data_of(source, "sim:threshold=8,bias=3,lapse=0"));
  REQUIRE(report["fits"].size() == 1);
  CHECK(report["fits"][0]["threshold"].get<double>() == Approx(3).margin(1.8));
  CHECK(report["fits"][0]["positive"] == "\u201cright\u201d");
  // a person for whom the first answer is the one that becomes more frequent
  const auto turned = report_of(answered_by(source, [](const auto& q) { return q.level > 3 ? 0 : 1; }));
  CHECK(turned["fits"][0]["positive"] == "\u201cleft\u201d");
}

TEST_CASE("each level factor has its own fit, with its own unit", "[report]") {
  auto source =
      replaced(shipped("demo"), "[[block]]",
               "[[procedure]]\nname = \"pushes\"\nkind = \"constant-stimuli\"\nlevel = \"push_um\"\n"
               "values = [-4.0, -2.0, 2.0, 4.0]\nrepeats = 30\nwith = { offset_mm = 0.0 }\n\n[[block]]");
  source = replaced(source, "procedures = [\"levels\"]",
                    "procedures = [\"levels\", \"pushes\"]\ninterleave = \"random\"");
  source =
      replaced(source, "[[factor]]", "[[factor]]\nname = \"push_um\"\nrange = [-5.0, 5.0]\n\n[[factor]]");
  source = replaced(source, "left = \"offset_mm < 0\"", "left = \"offset_mm + push_um < 0\"");
  source = replaced(source, "right = \"offset_mm > 0\"", "right = \"offset_mm + push_um > 0\"");
  source = replaced(source, "order = {", "with = { push_um = 0.0 }\norder = {");
  source = replaced(source, "repeats = 2", "repeats = 20");
  const auto data = data_of(source, "sim:threshold=3,lapse=0");
  REQUIRE(data.parts.size() == 2);
  const auto report = report_of(data);
  REQUIRE(report["fits"].size() == 2);
  CHECK(report["fits"][0]["name"] == "offset_mm");
  CHECK(report["fits"][0]["level_unit"] == "mm");
  CHECK(report["fits"][1]["name"] == "push_um");
  CHECK(report["fits"][1]["level_unit"] == "\u00b5m");
  CHECK(report["fits"][0]["levels"].size() == 5);
  CHECK(report["fits"][1]["levels"].size() == 4);
  CHECK(report["measures"].size() == 2);
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("PSE (\u00b5m)") != std::string::npos);
}

TEST_CASE("one key, always right and always wrong: there is a report with reasons", "[report]") {
  using Choice = std::function<std::optional<int>(const simulation::Question&)>;
  // a rehearsal ends only if trials are answered; sweep.py has a person who never answers
  const Choice choices[] = {[](const auto&) { return 0; },
                            [](const auto& q) { return q.correct.value_or(0); },
                            [](const auto& q) { return 1 - q.correct.value_or(0); }};
  for (const auto* name : {"friction-2ifc", "demo", "speed-accuracy", "friction-staircase"})
    for (const auto& choice : choices) {
      INFO(name);
      const auto data = answered_by(shipped(name), choice);
      const auto report = report_of(data);
      CHECK_NOTHROW(report::to_html(report::summarise(data)));
      for (const auto& fit : report["fits"])
        if (fit["threshold"].is_null()) CHECK_FALSE(fit["statements"].empty());
    }
}

TEST_CASE("A report of a payoff has the points a trial and a minute of each condition, and their differences",
          "[report]") {
  const auto paid = replaced(replaced(shipped("speed-accuracy"), "[timing]\n",
                                      "[payoff]\nright = 10\nwrong = -10\nlate = -20\n\n[timing]\n"),
                             "anticipation_s = 0.150", "anticipation_s = 0.150\ndelay_s = { wrong = 2.0 }");
  const auto data = data_of(paid);
  const auto json = report_of(data);
  REQUIRE(json["instructions"].size() == 2);
  for (const auto& entry : json["instructions"]) {
    double points = 0, minutes = 0, trials = 0;
    for (const auto& trial : data.trials)
      if (trial.type == analysis::TrialType::experimental && trial.instruction == entry["instruction"])
        points += trial.points.value(), minutes += trial.duration_s / 60, ++trials;
    CHECK(entry["points"]["value"].get<double>() == Approx(points / trials));
    CHECK(entry["points_per_minute"]["value"].get<double>() == Approx(points / minutes));
    CHECK(entry["points_per_minute"]["interval"]["low"].get<double>() < points / minutes);
  }
  int differences = 0;
  for (const auto& difference : json["differences"]) {
    if (difference["measure"] != "points a minute") continue;
    ++differences;
    CHECK(difference["estimate"]["value"].get<double>() ==
          Approx(json["instructions"][1]["points_per_minute"]["value"].get<double>() -
                 json["instructions"][0]["points_per_minute"]["value"].get<double>()));
  }
  CHECK(differences == 1);
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("Points a minute, of trials with their pauses") != std::string::npos);
  const auto unpaid = report::to_html(report::summarise(data_of(shipped("speed-accuracy"))));
  CHECK(unpaid.find("Points a") == std::string::npos);
}

TEST_CASE("Whoever is always right has points a trial, and counts in the study's mean", "[report]") {
  const auto paid =
      replaced(shipped("speed-accuracy"), "[timing]\n", "[payoff]\nright = 10\nwrong = -10\n\n[timing]\n");
  const auto right = answered_by(paid, [](const auto& q) { return q.correct.value_or(0); });
  const auto json = report_of(right);
  REQUIRE(json["instructions"].size() == 2);
  for (const auto& entry : json["instructions"]) CHECK(entry["points"]["value"] == 10);
  report::Study study;
  study.settings.scored = true;
  for (const auto* name : {"P01", "P02", "P03"}) {
    auto data = name == std::string("P01") ? right : data_of(paid);
    data.participant = name;
    study.persons.push_back(report::study_person(data, {}, false));
  }
  report::finish_study(study);
  int means = 0;
  for (const auto& mean : study.means)
    if (mean.measure == "points a trial") {
      ++means;
      CHECK(mean.persons == 3);
    }
  CHECK(means == 2);
}

TEST_CASE("A report of an unforced choice counts unsure answers and fits no diffusion", "[report]") {
  const auto data = data_of(shipped("friction-unforced"), "sim:lapse=0,unsure=0.9");
  double unsure = 0, right = 0;
  for (const auto& trial : data.trials)
    if (trial.type == analysis::TrialType::experimental)
      unsure += trial.unsure ? 1 : 0, right += trial.correct.value_or(false) ? 1 : 0;
  REQUIRE(unsure > 3);
  const auto json = report_of(data);
  CHECK(json["trials"]["unsure"] == unsure);
  double positive = 0;
  for (const auto& level : json["fits"][0]["levels"]) positive += level["positive"].get<double>();
  CHECK(positive == Approx(right + 0.5 * unsure));
  CHECK(json["instructions"][0]["boundary"].is_null());
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("<tr><th>Unsure</th>") != std::string::npos);
}

TEST_CASE("all pairs give a scale, by Bradley and Terry or by Thurstone", "[report]") {
  const auto source = shipped("friction-pairs");
  const auto data = data_of(source, "sim:threshold=4,lapse=0,bias=1");
  CHECK(data.meaning ==
        "places on a scale of the values of `first_dB` and `second_dB`, from all pairs (Bradley and Terry)");
  const auto report = report_of(data);
  CHECK(report["fits"].empty());
  REQUIRE(report["scales"].size() == 1);
  const auto& scale = report["scales"][0];
  CHECK(scale["model"] == "bradley-terry");
  CHECK(scale["trials"] == 120);
  REQUIRE(scale["stimuli"].size() == 6);
  double sum = 0, chosen = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& at = scale["stimuli"][i];
    CHECK(at["presented"] == 40);
    chosen += at["chosen"].get<double>();
    sum += at["value"]["value"].get<double>();
    CHECK(at["value"]["interval"]["low"] < at["value"]["value"]);
    // neighbours are less than a threshold apart
    if (i > 1) CHECK(at["value"]["value"] > scale["stimuli"][i - 2]["value"]["value"]);
  }
  CHECK(sum == Approx(0).margin(1e-9));
  CHECK(chosen == 120);
  CHECK(scale["stimuli"][0]["stimulus"] == -24);
  CHECK(scale["favours_second"]["value"] < 0);  // the bias asks for more
  CHECK(scale["degrees_of_freedom"] == 30 - 6);
  CHECK(scale["triples"] == 20);
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("Scale of the stimuli") != std::string::npos);
  CHECK(html.find("Circular triples") != std::string::npos);
  const auto other =
      report_of(data_of(source + "\n[analysis]\npairs = \"thurstone\"\n", "sim:threshold=4,lapse=0"));
  CHECK(other["scales"][0]["model"] == "thurstone");
  // the observer's 75 % point is 4 dB: 0.674 standard deviations of a difference, which is a d' of 0.954
  const auto& stimuli = other["scales"][0]["stimuli"];
  CHECK(stimuli[5]["value"]["value"].get<double>() - stimuli[0]["value"]["value"].get<double>() ==
        Approx(20 * 0.954 / 4).epsilon(0.35));
}

TEST_CASE("triads and quadruples give a scale of differences", "[report]") {
  const auto source = shipped("friction-triads");
  const auto report = report_of(data_of(source, "sim:threshold=3,lapse=0"));
  REQUIRE(report["scales"].size() == 1);
  const auto& scale = report["scales"][0];
  CHECK(scale["model"] == "differences");
  CHECK(scale["trials"] == 105);
  const auto& stimuli = scale["stimuli"];
  REQUIRE(stimuli.size() == 7);
  CHECK(stimuli[0]["value"]["value"] == 0);
  CHECK(stimuli[6]["value"]["value"] == 1);
  // the simulated observer's scale is straight: -11 dB is at 13 / 20
  CHECK(stimuli[3]["value"]["value"].get<double>() == Approx(0.65).margin(0.12));
  // in many such sessions the standard deviation of the noise is 0.08 (turnpoint power)
  CHECK(scale["noise"]["value"].get<double>() == Approx(3 / 0.6745 / 20).margin(0.2));
  CHECK(scale["stimuli"][3]["chosen"].is_null());
  CHECK(scale["runs_p"].get<double>() > 0);
  auto four = replaced(source, "[\"first\", \"second\", \"third\"]",
                       "[\"first\", \"second\", \"third\", \"fourth\"]");
  four = replaced(four, "against = [\"second_dB\", \"third_dB\"]",
                  "against = [\"second_dB\", \"third_dB\", \"fourth_dB\"]");
  four =
      replaced(four, "[task]",
               "[[factor]]\nname = \"fourth_dB\"\nrange = [-24.0, -4.0]\n[scene.fourth]\nbase = \"plain\"\n"
               "friction_contrast_dB = \"fourth_dB\"\n[task]");
  const auto quadruples = report_of(data_of(four, "sim:threshold=3,lapse=0"));
  CHECK(quadruples["scales"][0]["trials"] == 105);
  CHECK(quadruples["scales"][0]["stimuli"][3]["value"]["value"].get<double>() == Approx(0.65).margin(0.15));
}
