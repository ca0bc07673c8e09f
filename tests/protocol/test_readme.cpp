// protocols/README.md is the manual of protocol files: its examples must be valid.
#include <sstream>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/protocol.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

const std::string readme_path = std::string(TURNPOINT_SOURCE_DIR) + "/protocols/README.md";

std::vector<std::string> snippets() {
  std::istringstream lines(core::read_file(readme_path));
  std::vector<std::string> all;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "```toml") {
      inside = true;
      all.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      all.back() += line + "\n";
    }
  }
  return all;
}

std::vector<core::Problem> problems_of(const std::string& source) {
  try {
    protocol::parse(source, "readme.toml");
    return {};
  } catch (const core::BadInput& error) {
    return error.problems();
  }
}

// An example may lack what only a complete file contains. Any other problem is a mistake in the manual.
bool lacks_the_rest(const core::Problem& problem) {
  for (const auto* part :
       {"the file needs", "the file has no", "unknown factor", "unknown scene", "unknown procedure",
        "not a declared language", "has no value", "there is no [instructions", "has no deadline",
        "second scene", "nothing ends the interval", "unknown key \"offset_mm\"", "nothing above is called"})
    if (core::say(problem.what, "en").find(part) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("the manual's complete example is a valid protocol file", "[protocol]") {
  const auto all = snippets();
  REQUIRE(all.size() >= 10);
  CHECK(problems_of(all.front()).empty());
}

TEST_CASE("every example of the manual is valid, apart from what stands elsewhere in a file", "[protocol]") {
  for (const auto& snippet : snippets()) {
    INFO(snippet);
    for (const auto& problem : problems_of(snippet)) {
      INFO(format(problem));
      CHECK(lacks_the_rest(problem));
    }
  }
}
