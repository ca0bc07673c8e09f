#include "tests/protocol/known_keys.hpp"

#include <filesystem>
#include <sstream>

#include "station/protocol/protocol.hpp"
#include "station/system/read_file.hpp"
#include "station/text/toml.hpp"

namespace turnpoint::tests {

namespace {

// Adds `zzzzzz = 1` to each table of a protocol, both to tables with a header and to those in braces.
std::string with_unknown_keys(const std::string& source) {
  std::istringstream lines(source);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    for (std::size_t at = 0; (at = line.find("{ ", at)) != std::string::npos; at += 2)
      if (line.compare(at, 5, "{ en ") != 0) line.insert(at + 2, "zzzzzz = 1, ");
    result += line + "\n";
    if (!line.empty() && line[0] == '[') result += "zzzzzz = 1\n";
  }
  return "zzzzzz = 1\n" + result;
}

void collect(const std::string& allowed, std::set<std::string>& keys) {
  const auto at = allowed.find("known: ");
  if (at == std::string::npos) return;
  std::istringstream words(allowed.substr(at + 7));
  for (std::string word; words >> word;) {
    if (word.back() == ',') word.pop_back();
    keys.insert(word);
  }
}

}  // namespace

std::set<std::string> known_keys() {
  std::set<std::string> keys;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TURNPOINT_SOURCE_DIR) + "/protocols")) {
    if (entry.path().extension() != ".toml") continue;
    try {
      protocol::parse(with_unknown_keys(system::read_file(entry.path().string())), "p.toml");
    } catch (const text::BadInput& error) {
      for (const auto& problem : error.problems())
        if (texts::say(problem.what, "en").find("unknown key \"zzzzzz\"") != std::string::npos)
          collect(texts::say(problem.allowed, "en"), keys);
    }
  }
  return keys;
}

}  // namespace turnpoint::tests
