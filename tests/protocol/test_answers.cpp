#include "station/protocol/answers.hpp"

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/resolve.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

using namespace turnpoint;
using protocol::AnswerKind;

namespace {

std::string source_of(const std::string& name) {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

protocol::Protocol shipped(const std::string& name) { return protocol::parse(source_of(name), name); }

/// The shipped speed-accuracy protocol, changed to a yes/no task in which `change` is never negative.
protocol::Protocol yes_no() {
  auto text = replaced(source_of("speed-accuracy"), "range = [-0.4, 0.4]", "range = [0.0, 0.4]");
  text = replaced(text, "correct = { smoother = \"change < 0\", rougher = \"change > 0\" }",
                  "correct = { smoother = \"change == 0\", rougher = \"change > 0\" }");
  return protocol::parse(
      replaced(text, "values = [-0.4, -0.2, -0.1, 0.1, 0.2, 0.4]", "values = [0.0, 0.0, 0.05, 0.1, 0.3]"),
      "yes-no");
}

}  // namespace

TEST_CASE("the relation of the answers to the level is derived from their comparisons", "[protocol]") {
  const auto rule = [](const protocol::Protocol& protocol) {
    return protocol::answer_rule(protocol, protocol.procedures.front().level);
  };
  CHECK(rule(shipped("friction-2ifc")).kind == AnswerKind::right_answer);
  CHECK(rule(shipped("two-spots-oddity")).kind == AnswerKind::right_answer);
  CHECK(rule(shipped("friction-3ifc")).kind == AnswerKind::right_answer);
  CHECK(rule(shipped("friction-abx")).kind == AnswerKind::right_answer);
  CHECK(rule(shipped("boundary-constant")).kind == AnswerKind::side);
  CHECK(rule(shipped("boundary-constant")).positive == 1);
  const auto turned =
      protocol::parse(replaced(source_of("boundary-constant"),
                               "correct = { left = \"offset_mm < 0\", right = \"offset_mm > 0\" }",
                               "correct = { left = \"offset_mm > 0\", right = \"offset_mm < 0\" }"),
                      "turned");
  CHECK(rule(turned).positive == 0);
  CHECK(rule(shipped("friction-same-different")).kind == AnswerKind::presence);
  CHECK(rule(yes_no()).kind == AnswerKind::presence);
  CHECK(rule(yes_no()).positive == 1);
  const auto five = rule(shipped("friction-identification"));
  CHECK(five.kind == AnswerKind::category);
  CHECK(five.categories == std::vector<double>{-24, -19, -14, -9, -4});
  // If another factor decides which answer is right, the level determines how easy the right answer is to
  // find.
  const auto marks = replaced(source_of("boundary-constant"),
                              "correct = { left = \"offset_mm < 0\", right = \"offset_mm > 0\" }",
                              "correct = { left = \"mark_mm < 155\", right = \"mark_mm > 155\" }");
  CHECK(rule(protocol::parse(marks, "marks")).kind == AnswerKind::right_answer);
}

TEST_CASE("the middle of a protocol's levels is known for every procedure", "[protocol]") {
  const auto middle = [](const protocol::Protocol& protocol) {
    return protocol::middle_level(protocol, protocol.procedures.front().level);
  };
  CHECK(middle(shipped("friction-staircase")) == Approx(-18.5));  // the middle of the limits -34 and -3 dB
  CHECK(middle(shipped("friction-2ifc")) == Approx(-16.5));
  CHECK(middle(shipped("boundary-adaptive")) == Approx(12).margin(0.5));
  CHECK(middle(shipped("boundary-constant")) == Approx(12));
  CHECK(middle(shipped("demo")) == Approx(18));  // the level 0 does not count for the middle
  CHECK(middle(shipped("two-spots-oddity")) == Approx(std::sqrt(80.0)));
  CHECK(middle(yes_no()) == Approx(0.1));
}

namespace {

/// A protocol of two answers, `low` and `high`, about a level; `correct` is the inside of the table.
protocol::Protocol two_answers(const std::string& correct, const std::string& range,
                               const std::string& values, const std::string& name = "level_mm") {
  std::string text = replaced(source_of("demo"), "left = \"offset_mm < 0\"", correct);
  text = replaced(text, "right = \"offset_mm > 0\"", "");
  if (correct.empty()) text = replaced(text, "[task.correct]", "");
  text = replaced(text, "id = \"left\"", "id = \"low\"");
  text = replaced(text, "id = \"right\"", "id = \"high\"");
  text = replaced(text, "range = [-24.0, 24.0]", "range = " + range);
  text = replaced(text, "values = [-24.0, -12.0, 0.0, 12.0, 24.0]", "values = " + values);
  text = replaced(text, "boundary_mm = \"mark_mm + offset_mm\"", "boundary_mm = \"mark_mm + 0 * offset_mm\"");
  if (correct.empty()) text = replaced(text, "feedback = \"trial\"", "");
  for (auto at = text.find("offset_mm"); at != std::string::npos; at = text.find("offset_mm"))
    text.replace(at, 9, name);
  return protocol::parse(text, "two.toml");
}

std::string meaning(const protocol::Protocol& protocol, std::size_t which = 0) {
  return protocol::in_words(protocol.meanings.at(which), protocol);
}

}  // namespace

TEST_CASE("two answers below and above a cut have a PSE, wherever the cut and the range lie", "[protocol]") {
  struct Case {
    const char *correct, *range, *values;
    double cut;
  };
  for (const auto& c : {Case{"low = \"offset_mm < 20\"\nhigh = \"offset_mm > 20\"", "[0.0, 40.0]",
                             "[5.0, 15.0, 20.0, 25.0, 35.0]", 20},
                        Case{"low = \"offset_mm < 20\"\nhigh = \"offset_mm >= 20\"", "[0.0, 40.0]",
                             "[0.0, 15.0, 20.0, 25.0, 35.0]", 20},
                        Case{"low = \"offset_mm < 12.5\"\nhigh = \"offset_mm > 12.5\"", "[10.0, 30.0]",
                             "[10.0, 12.0, 13.0, 14.0, 30.0]", 12.5},
                        Case{"low = \"offset_mm < -3\"\nhigh = \"offset_mm > -3\"", "[-40.0, -1.0]",
                             "[-10.0, -5.0, -3.0, -2.0, -1.0]", -3},
                        Case{"low = \"offset_mm <= 9\"\nhigh = \"offset_mm >= 11\"", "[0.0, 40.0]",
                             "[5.0, 9.0, 11.0, 25.0, 35.0]", 10}}) {
    const auto protocol = two_answers(c.correct, c.range, c.values);
    REQUIRE(protocol.meanings.size() == 1);
    const auto& found = protocol.meanings.front();
    INFO(c.correct);
    CHECK(found.design == protocol::Design::two_sided);
    CHECK(found.rule.positive == 1);
    CHECK(found.rule.cut == Approx(c.cut));
    CHECK(found.function == core::Function::normal);
    CHECK_FALSE(found.log_axis);
  }
  const auto words = two_answers("low = \"offset_mm < 20\"\nhigh = \"offset_mm > 20\"", "[0.0, 40.0]",
                                 "[5.0, 15.0, 20.0, 25.0, 35.0]", "distance_mm");
  CHECK(protocol::line_of(words.meanings[0], words) ==
        "main: PSE and spread of `distance_mm` around 20, cumulative normal");
}

TEST_CASE("one answer near zero and another far from it have a PSE of the size", "[protocol]") {
  const auto inside = two_answers("low = \"abs(offset_mm) < 10\"\nhigh = \"abs(offset_mm) > 10\"",
                                  "[-40.0, 40.0]", "[-30.0, -5.0, 5.0, 15.0, 30.0]");
  CHECK(meaning(inside) == "PSE and spread of the size of `level_mm` around 10, cumulative normal");
  // a signal that is there or not is detected
  const auto detected = two_answers("low = \"offset_mm == 0\"\nhigh = \"abs(offset_mm) > 0\"",
                                    "[-40.0, 40.0]", "[-30.0, 0.0, 0.0, 0.0, 30.0]");
  CHECK(detected.meanings[0].design == protocol::Design::yes_no);
  CHECK(detected.meanings[0].size);
  const auto above = two_answers("low = \"offset_mm < 1\"\nhigh = \"offset_mm >= 1\"", "[0.0, 40.0]",
                                 "[0.0, 0.0, 5.0, 15.0, 30.0]");
  CHECK(above.meanings[0].design == protocol::Design::yes_no);
}

TEST_CASE("of left, don't know and right, the report says how often each is given", "[protocol]") {
  auto text = replaced(source_of("demo"), "left = \"offset_mm < 0\"", "");
  text = replaced(text, "right = \"offset_mm > 0\"", "");
  text = replaced(text, "[task.correct]", "");
  text = replaced(text, "feedback = \"trial\"", "");
  text = replaced(text, "device = \"either\"", "device = \"touch\"");
  text = replaced(text, "[[task.choices]]\nid = \"right\"",
                  "[[task.choices]]\nid = \"unsure\"\nlabel = { en = \"Don't know\", de = \"Unsicher\", ja = "
                  "\"わからない\" }\n\n[[task.choices]]\nid = \"right\"");
  const auto found = protocol::parse(text, "third.toml");
  CHECK(found.meanings[0].design == protocol::Design::categories);
  CHECK(meaning(found) == "how often each of 3 answers is given at each `offset_mm`");
}

TEST_CASE("two answers of which none is right have a PSE", "[protocol]") {
  const auto found = two_answers("", "[-40.0, 40.0]", "[-30.0, -5.0, 5.0, 15.0, 30.0]");
  CHECK(meaning(found) == "PSE and spread of `level_mm` by the answer \u201chigh\u201d, cumulative normal");
  CHECK(two_answers("", "[5.0, 45.0]", "[5.0, 15.0, 20.0, 25.0, 45.0]").meanings[0].rule.cut == 25);
}

TEST_CASE("procedures with different level factors are different analyses, interleaved tracks are one",
          "[protocol]") {
  CHECK(shipped("friction-training").meanings.size() == 1);
  CHECK(shipped("boundary-adaptive").meanings.size() == 1);
  auto text = replaced(source_of("demo"), "[[block]]",
                       "[[procedure]]\nname = \"marks\"\nkind = \"constant-stimuli\"\nlevel = \"mark_mm\"\n"
                       "values = [150.0, 160.0]\nrepeats = 3\nwith = { offset_mm = 12.0 }\n\n[[block]]");
  text = replaced(text, "procedures = [\"levels\"]",
                  "procedures = [\"levels\", \"marks\"]\ninterleave = \"random\"");
  const auto two = protocol::parse(text, "two.toml");
  REQUIRE(two.meanings.size() == 2);
  CHECK(two.meanings[0].name == "offset_mm");
  CHECK(two.meanings[1].name == "mark_mm");
  CHECK(protocol::meaning_of(two, "marks", "main") == 1);
  // procedures of one factor that hold another factor at different values
  auto each = replaced(source_of("demo"), "balance = [\"mark_mm\"]", "for_each = \"mark_mm\"");
  each = replaced(each, "procedures = [\"levels\"]", "procedures = [\"levels\"]\ninterleave = \"random\"");
  const auto marks = protocol::parse(each, "each.toml");
  REQUIRE(marks.meanings.size() == 2);
  CHECK(marks.meanings[1].name == "mark 160 mm");
  const auto separated = protocol::parse(each + "\n[analysis]\nby = \"mark_mm\"\n", "by.toml");
  CHECK(separated.meanings.size() == 1);  // the conditions separate them already
}

TEST_CASE("every shipped protocol says in one line what it measures", "[protocol]") {
  const auto line = [](const std::string& name) {
    const auto protocol = shipped(name);
    return protocol::line_of(protocol.meanings.at(0), protocol);
  };
  CHECK(line("friction-2ifc") ==
        "main: threshold of `contrast_dB` at 81.6 % correct, guess rate 0.5, Weibull");
  CHECK(line("boundary-constant") == "main: PSE and spread of `offset_mm` around 0, cumulative normal");
  CHECK(line("friction-identification") == "main: confusions of 5 answers at each `contrast_dB`");
  CHECK(line("boundary-adjustment") == "main: settings of `offset_mm`, their mean (PSE) and scatter");
}

TEST_CASE("a zone is designed for the friction of its base scene, so the factors of the base count",
          "[protocol]") {
  auto text = replaced(source_of("friction-2ifc"), "friction = 0.75", "friction = \"start\"");
  text = replaced(text, "friction_contrast_dB = \"contrast_dB\"",
                  "zone = { friction = \"0.5 + 0 * contrast_dB\" }");
  text = replaced(text, "[[factor]]", "[[factor]]\nname = \"start\"\nlevels = [0.7, 0.75]\n\n[[factor]]");
  const auto protocol = protocol::parse(text, "zones.toml");
  CHECK(protocol::factors_of(protocol.scenes.at("comparison")).count("start") == 1);
  for (const auto& combination : protocol::combinations_of(protocol))
    CHECK_NOTHROW(protocol::resolve(protocol, combination.scene, combination.factors, 0));
}

TEST_CASE("in two intervals the level can decide which scene is right", "[protocol]") {
  const auto two = [](const std::string& correct) {
    auto source = replaced(source_of("friction-2ifc"), "correct = \"comparison\"", "correct = " + correct);
    return protocol::parse(source, "two.toml");
  };
  const auto signs = two("{ comparison = \"contrast_dB > -15\", reference = \"contrast_dB <= -15\" }");
  CHECK(protocol::in_words(signs.meanings[0], signs) ==
        "PSE and spread of `contrast_dB` around -15 by the interval with `comparison`, cumulative normal");
  CHECK(protocol::scene_of(signs.task, 1) == "comparison");
  CHECK_THROWS_AS(two("{ comparison = \"contrast_dB > -15\" }"), core::BadInput);
  CHECK_THROWS_AS(two("{ comparison = \"contrast_dB > 0\", other = \"contrast_dB < 0\" }"), core::BadInput);
}

TEST_CASE("An interval presents a factor of its own, not the one that its scene replaces in its base",
          "[protocol]") {
  const auto pairs = [](const std::string& second) {
    return R"(format = "friction-protocol/1"
[protocol]
id = "pairs"
version = "1.0.0"
title = "Pairs"
languages = ["en"]
[[factor]]
name = "a"
range = [0.3, 0.9]
[[factor]]
name = "b"
range = [0.3, 0.9]
[scene.first]
boundary_mm = 185.0
edge = "p50"
zone = { from_mm = 60.0, friction = "a", tones = 3 }
tolerance = { level_dB = 0.1 }
[scene.second]
base = "first"
)" + second +
           R"(
[task]
kind = "comparison"
intervals = ["first", "second"]
duration_s = 1.5
gap_s = 0.8
device = "touch"
question = { en = "Which was smoother?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
[timing]
response_zero = "interval_off"
deadline_s = 6.0
iti_s = 1.0
[[procedure]]
name = "pairs"
kind = "comparisons"
level = "a"
against = ["b"]
values = [0.4, 0.48, 0.56]
repeats = 4
[[block]]
name = "main"
procedures = ["pairs"]
[analysis]
pairs = "bradley-terry"
)";
  };
  CHECK_NOTHROW(protocol::parse(pairs("zone = { friction = \"b\" }"), "pairs"));
  CHECK_THROWS_WITH(protocol::parse(pairs("ramp_ms = 60.0"), "pairs"),
                    Catch::Matchers::ContainsSubstring(
                        "interval 2 presents \"a\": the scene \"second\" depends on it, as its "
                        "base \"first\" does"));
  CHECK_THROWS_WITH(protocol::parse(pairs("zone = { friction = 0.5 }"), "pairs"),
                    Catch::Matchers::ContainsSubstring("interval 2 does not present \"b\""));
}
