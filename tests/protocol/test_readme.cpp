// The pages beside the protocols are the manual of protocol files: their examples must be valid.
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/protocol.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

const std::string folder = std::string(TURNPOINT_SOURCE_DIR) + "/protocols";

std::vector<std::string> pages() {
  std::vector<std::string> all;
  for (const auto& file : std::filesystem::directory_iterator(folder))
    if (file.path().extension() == ".md") all.push_back(file.path().string());
  std::ranges::sort(all);
  return all;
}

std::vector<std::string> snippets(const std::string& page) {
  std::istringstream lines(core::read_file(page));
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

TEST_CASE("the guide's complete example is a valid protocol file", "[protocol]") {
  const auto all = snippets(folder + "/README.md");
  REQUIRE(all.size() >= 10);
  CHECK(problems_of(all.front()).empty());
}

TEST_CASE("every example of the pages is valid, apart from what stands elsewhere in a file", "[protocol]") {
  std::size_t tried = 0;
  for (const auto& page : pages())
    for (const auto& snippet : snippets(page)) {
      INFO(page << ":\n" << snippet);
      ++tried;
      for (const auto& problem : problems_of(snippet)) {
        INFO(format(problem));
        CHECK(lacks_the_rest(problem));
      }
    }
  CHECK(tried >= 40);
}
