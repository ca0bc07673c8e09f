#include "station/protocol/answers.hpp"

#include "station/system/read_file.hpp"
#include "station/text/toml.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using protocol::AnswerKind;

namespace {

std::string source_of(const std::string& name) {
  return system::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

protocol::Protocol shipped(const std::string& name) { return protocol::parse(source_of(name), name); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

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
