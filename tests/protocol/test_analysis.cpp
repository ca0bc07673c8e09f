#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/protocol.hpp"
#include "tests/support/catch.hpp"

// Tests the [analysis] table of a protocol file: every accepted value must have an effect.

using namespace turnpoint;

namespace {

std::string source_of(const std::string& name) {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

/// Returns a shipped protocol whose [analysis] table is replaced.
std::string with_analysis(const std::string& name, const std::string& analysis) {
  auto source = source_of(name);
  if (const auto at = source.find("[analysis]"); at != std::string::npos)
    source.erase(at, source.find("[resume]") - at);
  return source + "\n[analysis]\n" + analysis + "\n";
}

std::vector<core::Problem> problems_of(const std::string& source) {
  try {
    protocol::parse(source, "p.toml");
    return {};
  } catch (const core::BadInput& error) {
    return error.problems();
  }
}

std::string only_problem(const std::string& source) {
  const auto problems = problems_of(source);
  REQUIRE(problems.size() == 1);
  CHECK(!problems.front().allowed.empty());
  CHECK(problems.front().place.line > 1);
  return core::say(problems.front().what, "en");
}

}  // namespace

TEST_CASE("the key by accepts one factor with levels, or several", "[protocol]") {
  const auto one = protocol::parse(with_analysis("speed-accuracy", "by = \"instruction\""), "p");
  CHECK(one.analysis.by == std::vector<std::string>{"instruction"});
  const auto two = protocol::parse(with_analysis("demo", "by = [\"mark_mm\"]"), "p");
  CHECK(two.analysis.by == std::vector<std::string>{"mark_mm"});
  CHECK(only_problem(with_analysis("demo", "by = [\"mark\"]")).find("unknown factor") == 0);
  CHECK(only_problem(with_analysis("demo", "by = [\"mark_mm\", \"mark_mm\"]")).find("twice") !=
        std::string::npos);
  for (const auto& problem : problems_of(with_analysis("demo", "by = \"offset_mm\"")))
    CHECK(core::format(problem).find("offset_mm") != std::string::npos);
  CHECK(!problems_of(with_analysis("demo", "by = \"offset_mm\"")).empty());
}

TEST_CASE("a value of the key show that would show nothing is an error that says why", "[protocol]") {
  const std::vector<std::string> all{"psychometric", "ez", "bis", "lisas", "ies", "caf", "dprime", "trace"};
  const auto refused = [&](const std::string& protocol, const std::string& more = "") {
    std::vector<std::string> words;
    for (const auto& word : all)
      if (!problems_of(with_analysis(protocol, more + "show = [\"" + word + "\"]")).empty())
        words.push_back(word);
    return words;
  };
  using Words = std::vector<std::string>;
  CHECK(refused("speed-accuracy", "by = \"instruction\"\n") == Words{});
  CHECK(refused("friction-2ifc") == Words{"bis"});
  CHECK(refused("demo", "by = \"mark_mm\"\n") == Words{});
  CHECK(refused("two-spots-oddity") == Words{"bis", "dprime"});
  CHECK(refused("friction-3ifc") == Words{"ez", "bis"});
  CHECK(refused("friction-abx") == Words{"bis"});
  CHECK(refused("friction-identification") == Words{"psychometric", "ez", "bis", "dprime"});
  CHECK(refused("boundary-adjustment") ==
        Words{"psychometric", "ez", "bis", "lisas", "ies", "caf", "dprime"});
  // BIS needs two conditions in a study, of one difficulty or of several; groups of participants are
  // conditions too
  const auto demo_with = [](const std::string& factor, const std::string& by) {
    auto text = with_analysis("demo", by + "show = [\"bis\"]");
    return problems_of(text.insert(text.find("[task]"), "[[factor]]\nname = \"hand\"\n" + factor + "\n\n"));
  };
  CHECK_FALSE(demo_with("levels = [\"left\"]", "by = \"hand\"\n").empty());
  CHECK(demo_with("levels = [\"left\", \"right\"]", "by = \"hand\"\n").empty());
  CHECK_FALSE(demo_with("levels = [\"left\", \"right\"]", "").empty());
  CHECK(demo_with("levels = [\"left\", \"right\"]\ndraw = \"per-participant\"", "").empty());
  auto unscored = source_of("demo");
  const auto at = unscored.find("[task.correct]");
  unscored.erase(at, unscored.find("[timing]") - at);
  unscored.erase(unscored.find("feedback = \"trial\""), 18);
  CHECK(problems_of(unscored).empty());
  CHECK(only_problem(unscored + "[analysis]\nshow = [\"lisas\"]\n").find("no answer is right or wrong") !=
        std::string::npos);
  CHECK(only_problem(with_analysis("demo", "show = [\"d-prime\"]")).find("\"d-prime\"") != std::string::npos);
}
