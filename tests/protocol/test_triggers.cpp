#include "station/protocol/triggers.hpp"

#include <set>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/survey.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;
using protocol::TriggerEvent;

namespace {

/// Returns the protocol speed-accuracy with these triggers. Its two conditions are its two instructions.
protocol::Protocol with(const std::string& triggers) {
  const auto source =
      core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/speed-accuracy.toml") + "\n" + triggers;
  return protocol::parse(source, "p.toml");
}

std::string problem_with(const std::string& triggers) {
  std::string all;
  try {
    with(triggers);
  } catch (const core::BadInput& bad) {
    for (const auto& problem : bad.problems()) all += format(problem) + "\n";
  }
  return all;
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

rig::Rig rig_with(const std::string& lines, std::optional<double> bit_s = {}) {
  auto rig = quick_rig();
  if (!lines.empty()) rig.trigger_lines_uri = lines;
  if (bit_s) {
    rig.marker.emplace();
    rig.marker->kind = rig::Marker::Kind::code;
    rig.marker->duration_s = *bit_s;
  }
  return rig;
}

std::string survey_problems(const protocol::Protocol& protocol, const rig::Rig& rig) {
  std::string all;
  for (const auto& problem : protocol::survey(protocol, rig).problems) all += format(problem) + "\n";
  return all;
}

}  // namespace

TEST_CASE("by default each event of each condition has a code of its own", "[protocol][trigger]") {
  const auto protocol = with("");
  const auto codes = protocol::trigger_codes(protocol);
  // four events, each with the two instructions and without an instruction
  REQUIRE(codes.size() == 12);
  std::set<int> different;
  for (std::size_t k = 0; k < codes.size(); ++k) {
    CHECK(codes[k].code == static_cast<int>(k) + 1);
    different.insert(codes[k].code);
  }
  CHECK(different.size() == codes.size());
  const std::string first = codes[0].condition, second = codes[4].condition;
  CHECK(first != second);
  CHECK(codes[8].condition == "");
  CHECK(protocol::trigger_code(protocol, TriggerEvent::onset, {{"instruction", first}}) == 2);
  CHECK(protocol::trigger_code(protocol, TriggerEvent::response, {{"instruction", second}}) == 8);
  CHECK(protocol::trigger_code(protocol, TriggerEvent::trial, {}) == 9);
}

TEST_CASE("a protocol can choose the events and state their codes", "[protocol][trigger]") {
  const auto protocol = with(
      "[triggers]\nsend = [\"onset\", \"response\"]\n"
      "code = [{ event = \"onset\", condition = \"speed\", code = 100 }]\n");
  CHECK(protocol::trigger_codes(protocol).size() == 6);
  CHECK(protocol::trigger_code(protocol, TriggerEvent::onset, {{"instruction", "speed"}}) == 100);
  CHECK(protocol::trigger_code(protocol, TriggerEvent::trial, {{"instruction", "speed"}}) == 0);
  CHECK(protocol::trigger_code(protocol, TriggerEvent::onset, {}) == 5);
}

TEST_CASE("unusable trigger codes are refused", "[protocol][trigger]") {
  CHECK(
      contains(problem_with("[triggers]\nsend = [\"touch\"]"), "\"send\" has \"touch\"; allowed: \"trial\""));
  CHECK(contains(problem_with("[triggers]\nsend = [\"onset\", \"onset\"]"), "appears twice"));
  const auto code = [](const std::string& keys) {
    return problem_with("[triggers]\ncode = [{ " + keys + " }]");
  };
  CHECK(contains(code("event = \"onset\", condition = \"sped\", code = 99"), "did you mean \"speed\""));
  CHECK(contains(code("event = \"onset\", code = 300"), "1 to 255"));
  CHECK(contains(code("event = \"onset\", code = 2"), "the code 2 stands for"));
  CHECK(contains(problem_with("[triggers]\nsend = [\"trial\"]\ncode = [{ event = \"onset\", code = 99 }]"),
                 "\"onset\" is not in \"send\""));
}

TEST_CASE("check says when a rig has fewer codes than the protocol needs, or too little time for them",
          "[protocol][trigger]") {
  const auto protocol = with("");
  const std::string three = "gpio:bit0=A,bit1=B,bit2=C", four = three + ",bit3=D,strobe=E";
  CHECK(survey_problems(protocol, rig_with("")) == "");
  CHECK(survey_problems(protocol, rig_with(four)) == "");
  CHECK(survey_problems(protocol, rig_with("sim:")) == "");
  const auto few = survey_problems(protocol, rig_with(three));
  CHECK(
      contains(few, "the trigger codes go up to 12, for 2 conditions; the rig's outputs give codes up to 7"));
  CHECK(survey_problems(protocol, rig_with("", 1e-3)) == "");
  CHECK(contains(survey_problems(protocol, rig_with("", 0.2)), "a trigger code lasts 3000 ms"));
}
