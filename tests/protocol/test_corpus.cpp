// Each file of tests/protocol/bad contains one mistake (or a few). A line with a mistake that must be
// reported ends in `#! part of the message`. Messages about the file as a whole are given in its first line
// as `#!! part`.
#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/protocol.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(TURNPOINT_SOURCE_DIR) / "tests/protocol/bad";

std::map<int, std::string> expected_lines(const std::string& source) {
  std::map<int, std::string> expected;
  std::istringstream lines(source);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.rfind("#!! ", 0) == 0)
      expected[0] = line.substr(4);
    else if (const auto at = line.find("#! "); at != std::string::npos)
      expected[number] = line.substr(at + 3);
  }
  return expected;
}

std::vector<core::Problem> problems_of(const std::string& source) {
  try {
    protocol::parse(source, "p.toml");
    return {};
  } catch (const core::BadInput& error) {
    return error.problems();
  }
}

// Returns the differences between reported and expected problems: expected ones that were not reported, and
// unexpected ones that were.
std::string misreported(const std::string& source) {
  const auto expected = expected_lines(source);
  const auto problems = problems_of(source);
  std::string faults;
  for (const auto& [line, part] : expected) {
    const auto fits = [&, number = line, &text = part](const auto& problem) {
      return problem.place.line == number && format(problem).find(text) != std::string::npos;
    };
    if (std::none_of(problems.begin(), problems.end(), fits))
      faults += "line " + std::to_string(line) + " not reported as: " + part + "\n";
  }
  for (const auto& problem : problems)
    if (!expected.count(problem.place.line)) faults += "not expected: " + format(problem) + "\n";
  if (!faults.empty())
    for (const auto& problem : problems) faults += "  got " + format(problem) + "\n";
  return faults;
}

}  // namespace

TEST_CASE("each file of the corpus of mistakes is refused at the line of its mistake and nowhere else",
          "[protocol]") {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    const auto source = core::read_file(entry.path().string());
    INFO(entry.path().filename().string());
    CHECK_FALSE(expected_lines(source).empty());
    CHECK(misreported(source) == "");
  }
  CHECK(files >= 100);
}

TEST_CASE("the corpus check notices a file whose mistake was corrected, and a mistake on another line",
          "[protocol]") {
  auto source = core::read_file((folder / "scene-rove-negative.toml").string());
  REQUIRE(misreported(source).empty());
  const auto at = source.find("rove_dB = -2.0");
  auto mended = source;
  mended.replace(at, 14, "rove_dB = 2.0");
  CHECK_FALSE(misreported(mended).empty());
  auto second = source;
  second.replace(source.find("ramp_ms = 50"), 12, "ramp_ms = 0");
  CHECK_FALSE(misreported(second).empty());
}
