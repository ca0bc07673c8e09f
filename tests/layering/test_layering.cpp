#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"

namespace fs = std::filesystem;

namespace {

struct Table {
  std::map<std::string, std::set<std::string>> allowed;          // layer -> layers
  std::vector<std::pair<std::string, std::string>> system_only;  // header prefix, path prefix
};

Table read_table(const fs::path& path) {
  Table table;
  std::ifstream file(path);
  REQUIRE(file.good());
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string first, word;
    words >> first;
    if (first[0] == '<') {
      words >> word;
      table.system_only.emplace_back(first, word);
    } else {
      first.pop_back();
      auto& layers = table.allowed[first];
      while (words >> word) layers.insert(word);
    }
  }
  return table;
}

/// "physics", or "station/<layer>".
std::string layer_of(const std::string& path) {
  const auto first = path.find('/');
  if (path.substr(0, first) != "station") return path.substr(0, first);
  return path.substr(0, path.find('/', first + 1));
}

/// The rule that an include in `file` breaks, or "".
std::string violation(const Table& table, const std::string& file, const std::string& line) {
  const auto hash = line.find_first_not_of(' ');
  if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) return "";
  const auto open = line.find_first_of("<\"", hash);
  if (open == std::string::npos) return "";
  const auto header = line.substr(open);
  for (const auto& [prefix, home] : table.system_only) {
    const bool qt_like = prefix != "<Q" || (header.size() > 2 && std::isupper(header[1]) != 0);
    if (qt_like && header.rfind(prefix, 0) == 0 && file.rfind(home, 0) != 0)
      return file + " includes " + header + ", which belongs to " + home;
  }
  if (header[0] != '"') return "";
  const auto target = layer_of(header.substr(1));
  const auto own = layer_of(file);
  if (target == own || (target != "physics" && target.rfind("station/", 0) != 0)) return "";
  const auto found = table.allowed.find(own);
  if (found == table.allowed.end()) return file + ": layer " + own + " is not in the table";
  return found->second.count(target) ? ""
                                     : file + " includes " + header + ": " + own + " may not see " + target;
}

std::vector<std::string> violations(const Table& table, const fs::path& root) {
  std::vector<std::string> all;
  for (const auto* top : {"physics", "station"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const auto file = fs::relative(entry.path(), root).generic_string();
      if (file.rfind("physics/example", 0) == 0) continue;  // a client of the installed library
      std::ifstream text(entry.path());
      for (std::string line; std::getline(text, line);)
        if (auto what = violation(table, file, line); !what.empty()) all.push_back(std::move(what));
    }
  return all;
}

}  // namespace

TEST_CASE("every layer includes only what the table allows", "[layering]") {
  const fs::path root = TURNPOINT_SOURCE_DIR;
  const auto table = read_table(root / "tests/layering/allowed.txt");
  const auto found = violations(table, root);
  for (const auto& what : found) FAIL_CHECK(what);
  CHECK(found.empty());
}

TEST_CASE("an include against the table is found: the negative control", "[layering]") {
  const auto table = read_table(fs::path(TURNPOINT_SOURCE_DIR) / "tests/layering/allowed.txt");
  CHECK_FALSE(violation(table, "physics/field.cpp", "#include \"station/rig/rig.hpp\"").empty());
  CHECK_FALSE(violation(table, "station/trial/trial.cpp", "#include \"station/store/records.hpp\"").empty());
  CHECK_FALSE(violation(table, "station/session/session.cpp", "#include <sqlite3.h>").empty());
  CHECK_FALSE(violation(table, "station/session/session.cpp", "#include <QString>").empty());
  CHECK_FALSE(violation(table, "station/drive/engine.cpp", "#include <alsa/asoundlib.h>").empty());
  CHECK_FALSE(violation(table, "station/panel/touch_reader.cpp", "#include <libevdev/libevdev.h>").empty());
  CHECK(violation(table, "station/drive/alsa_output.cpp", "#include <alsa/asoundlib.h>").empty());
  CHECK(violation(table, "station/scene/planner.cpp", "#include \"physics/field.hpp\"").empty());
}
