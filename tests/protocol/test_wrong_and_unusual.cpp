// Tests the files in tests/protocol/corpus: wrong protocols with the line that must be reported, and unusual
// but correct ones. README.md there explains their form.
#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/design_advice.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/survey.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

const std::string root = TURNPOINT_SOURCE_DIR;

struct Case {
  std::string title, base;
  std::vector<std::pair<std::string, std::string>> edits;
};

std::string with_lines(std::string text) {
  for (auto at = text.find("\\n"); at != std::string::npos; at = text.find("\\n")) text.replace(at, 2, "\n");
  return text;
}

std::vector<Case> cases_in(const fs::path& path) {
  std::vector<Case> cases;
  std::istringstream lines(core::read_file(path.string()));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("## ", 0) == 0) {
      cases.push_back({line.substr(3), "", {}});
    } else if (!line.empty() && line[0] != '#' && !cases.empty()) {
      const auto arrow = line.find(" => ");
      if (arrow == std::string::npos)
        cases.back().base = line;
      else
        cases.back().edits.emplace_back(with_lines(line.substr(0, arrow)),
                                        with_lines(line.substr(arrow + 4)));
    }
  }
  return cases;
}

struct Edited {
  std::string source;
  std::set<int> must, may, note;  ///< lines that must be reported, may be reported, or must get a note
};

Edited edited(const Case& wanted) {
  Edited result;
  auto text = core::read_file(root + "/protocols/" + wanted.base + ".toml");
  for (const auto& [from, to] : wanted.edits) {
    const auto at = text.find(from);
    INFO("edit: " << from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  }
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    for (const auto& [mark, into] :
         {std::pair{"<!>", &result.must}, std::pair{"<~>", &result.may}, std::pair{"<?>", &result.note}})
      for (auto at = line.find(mark); at != std::string::npos; at = line.find(mark))
        line.erase(at, 3), into->insert(number);
    result.source += line + "\n";
  }
  return result;
}

bool follows(const protocol::Protocol& protocol) {
  return std::any_of(protocol.scenes.begin(), protocol.scenes.end(),
                     [](const auto& scene) { return scene.second.follow.has_value(); });
}

const rig::Rig& following() {
  static const auto rig = rig::load(root + "/deploy/rigs/simulated-following.toml");
  return rig;
}

const rig::Rig& quick() {
  static const auto rig = quick_rig();
  return rig;
}

/// The problems of the file or, if there are none, those found by a survey on a rig.
std::vector<core::Problem> said_of(const std::string& source) {
  try {
    const auto parsed = protocol::parse(source, "p.toml");
    auto survey = protocol::survey(parsed, follows(parsed) ? following() : quick());
    auto said = survey.problems;
    said.insert(said.end(), survey.warnings.begin(), survey.warnings.end());
    return said;
  } catch (const core::BadInput& error) {
    return error.problems();
  }
}

std::string missed(const Case& wanted) {
  const auto text = edited(wanted);
  std::set<int> said;
  std::string all;
  for (const auto& problem : said_of(text.source)) {
    said.insert(problem.place.line);
    all += "  " + format(problem) + "\n";
  }
  for (const int line : text.must)
    if (!said.count(line)) return "line " + std::to_string(line) + " is passed over; said is:\n" + all;
  if (text.note.empty()) return "";
  if (!said.empty()) return "more than a note is said:\n" + all;
  for (const auto& note : protocol::notes(protocol::parse(text.source, "p.toml")))
    said.insert(note.place.line);
  for (const int line : text.note)
    if (!said.count(line)) return "no note at line " + std::to_string(line);
  return "";
}

}  // namespace

TEST_CASE("each wrong protocol is refused, or warned of, at its line", "[protocol][corpus]") {
  int cases = 0;
  for (const auto& entry : fs::directory_iterator(root + "/tests/protocol/corpus")) {
    if (entry.path().filename().string().rfind("wrong-", 0) != 0) continue;
    for (const auto& wanted : cases_in(entry.path())) {
      INFO(entry.path().filename().string() << ": " << wanted.title);
      ++cases;
      CHECK(missed(wanted) == "");
    }
  }
  CHECK(cases >= 420);
}

TEST_CASE("negative control: a mistake that is not reported, or only at another line, is detected",
          "[protocol][corpus]") {
  CHECK(missed({"", "demo", {{"title =", "<!>title ="}}}) != "");
  CHECK(missed({"", "demo", {{"repeats = 2", "repeats = 0"}, {"title =", "<!>title ="}}}) != "");
  CHECK(missed({"", "demo", {{"repeats = 2", "<!>repeats = 0"}}}) == "");
  CHECK(missed({"", "demo", {{"iti_s =", "<?>iti_s ="}}}) != "");
  CHECK(missed({"", "demo", {{"iti_s = { uniform = [0.6, 1.0] }", "<?>iti_s = 0.0"}}}) == "");
}

TEST_CASE("unusual protocols that are right are accepted without an error or a warning",
          "[protocol][corpus]") {
  const auto cases = cases_in(root + "/tests/protocol/corpus/unusual.txt");
  CHECK(cases.size() >= 50);
  for (const auto& unusual : cases) {
    INFO(unusual.title);
    std::string all;
    for (const auto& problem : said_of(edited(unusual).source)) all += format(problem) + "\n";
    CHECK(all == "");
  }
}
