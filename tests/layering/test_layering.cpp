#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"

namespace fs = std::filesystem;

namespace {

using Layers = std::set<std::string>;

struct Table {
  std::vector<std::string> order;         // the layers from the bottom up
  std::map<std::string, Layers> allowed;  // for each layer, the layers that it may use
  // pairs of the beginning of a system header's name and the beginning of the only paths that may include it
  std::vector<std::pair<std::string, std::string>> system_only;
};

Table parse_table(std::istream& lines) {
  Table table;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string first, word;
    words >> first;
    if (first[0] == '<') {
      words >> word;
      table.system_only.emplace_back(first, word);
    } else {
      first.pop_back();
      table.order.push_back(first);
      auto& layers = table.allowed[first];
      while (words >> word) layers.insert(word);
    }
  }
  return table;
}

Table table_of_the_tree() {
  std::ifstream file(fs::path(TURNPOINT_SOURCE_DIR) / "tests/layering/allowed.txt");
  REQUIRE(file.good());
  return parse_table(file);
}

/// Returns the layer of a source file: "physics" or "station/<layer>".
std::string layer_of(const std::string& path) {
  const auto first = path.find('/');
  if (path.substr(0, first) != "station") return path.substr(0, first);
  return path.substr(0, path.find('/', first + 1));
}

/// Returns the layer to which this namespace belongs; "" if there is none.
std::string layer_of_namespace(const Table& table, const std::string& name) {
  for (const auto& layer : {name, "station/" + name})
    if (table.allowed.count(layer) > 0) return layer;
  return "";
}

/// Returns the line without its comment and without text in quotes.
std::string code_of(const std::string& line) {
  std::string code;
  char quote = '\0';
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != '\0') {
      if (c == '\\') ++i;
      if (c == quote) quote = '\0';
    } else if (c == '/' && line.compare(i, 2, "//") == 0) {
      break;
    } else if (c == '"' || (c == '\'' && (i == 0 || std::isalnum(line[i - 1]) == 0))) {
      quote = c;
    } else {
      code += c;
    }
  }
  return code;
}

std::string included_by(const std::string& line) {
  const auto hash = line.find_first_not_of(' ');
  if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) return "";
  const auto open = line.find_first_of("<\"", hash);
  return open == std::string::npos ? "" : line.substr(open);
}

/// Returns the other layers that a line of `file` uses by an include, a qualified name, or a declaration in
/// another layer's namespace.
Layers used_by(const Table& table, const std::string& file, const std::string& line) {
  Layers used;
  const auto header = included_by(line);
  if (!header.empty()) {
    const auto layer = header[0] == '"' ? layer_of(header.substr(1)) : "";
    if (layer == "physics" || layer.starts_with("station/")) used.insert(layer);
  } else {
    static const std::regex name(
        R"((?:^|[^\w:])(?:turnpoint::)?([a-z_]+)::|\bnamespace (?:turnpoint::)?([a-z_]+))");
    const auto code = code_of(line);
    for (std::sregex_iterator found(code.begin(), code.end(), name), end; found != end; ++found) {
      const auto layer = layer_of_namespace(table, (*found)[found->length(1) > 0 ? 1 : 2]);
      if (!layer.empty()) used.insert(layer);
    }
  }
  used.erase(layer_of(file));
  return used;
}

/// Describes how a line of `file` breaks the rules; "" if it does not.
std::string violation(const Table& table, const std::string& file, const std::string& line) {
  const auto header = included_by(line);
  for (const auto& [prefix, home] : table.system_only) {
    const bool qt_like = prefix != "<Q" || (header.size() > 2 && std::isupper(header[1]) != 0);
    if (qt_like && header.starts_with(prefix) && !file.starts_with(home))
      return file + " includes " + header + ", which belongs to " + home;
  }
  const auto own = layer_of(file);
  const auto found = table.allowed.find(own);
  if (found == table.allowed.end()) return file + ": layer " + own + " is not in the table";
  for (const auto& layer : used_by(table, file, line))
    if (found->second.count(layer) == 0) return file + ": " + own + " may not see " + layer + ": " + line;
  return "";
}

template <class Take>
void each_line(const fs::path& root, const Take& take) {
  for (const auto* top : {"physics", "station"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const auto file = fs::relative(entry.path(), root).generic_string();
      if (file.starts_with("physics/example")) continue;  // the example is a client of the installed library
      std::ifstream text(entry.path());
      for (std::string line; std::getline(text, line);) take(file, line);
    }
}

constexpr int kMostFloors = 9;

/// Returns the floor of each layer: 1 if it uses no other, otherwise the floor above the highest that it
/// uses. A layer that uses one that is not before it in the table is on floor 0.
std::map<std::string, int> floors_of(const Table& table) {
  std::map<std::string, int> floors;
  for (const auto& layer : table.order) {
    int highest = 0;
    bool upwards = false;
    for (const auto& other : table.allowed.at(layer)) {
      const auto found = floors.find(other);
      upwards = upwards || found == floors.end();
      if (!upwards) highest = std::max(highest, found->second);
    }
    floors[layer] = upwards ? 0 : highest + 1;
  }
  return floors;
}

/// Returns the entries of the table that no line of the sources needs, each as "LAYER: LAYER".
std::vector<std::string> unused(const Table& table, const std::map<std::string, Layers>& used) {
  std::vector<std::string> all;
  for (const auto& [layer, allowed] : table.allowed)
    for (const auto& other : allowed) {
      const auto found = used.find(layer);
      if (found == used.end() || found->second.count(other) == 0) all.push_back(layer + ": " + other);
    }
  return all;
}

}  // namespace

TEST_CASE("every layer uses only what the table allows, and every entry of the table is used", "[layering]") {
  const auto table = table_of_the_tree();
  std::map<std::string, Layers> used;
  each_line(TURNPOINT_SOURCE_DIR, [&](const std::string& file, const std::string& line) {
    if (const auto what = violation(table, file, line); !what.empty()) FAIL_CHECK(what);
    used[layer_of(file)].merge(used_by(table, file, line));
  });
  for (const auto& entry : unused(table, used)) FAIL_CHECK("allowed.txt allows what nothing uses: " << entry);
  CHECK(used.size() > 20);
}

TEST_CASE("the table goes from the bottom up, and the layers stand on few floors", "[layering]") {
  for (const auto& [layer, floor] : floors_of(table_of_the_tree())) {
    INFO(layer);
    CHECK(floor >= 1);
    CHECK(floor <= kMostFloors);
  }
  std::istringstream upwards("station/trial: station/store\nstation/store:\n");
  CHECK(floors_of(parse_table(upwards)).at("station/trial") == 0);
  std::istringstream high("station/store:\nstation/trial: station/store\n");
  CHECK(floors_of(parse_table(high)).at("station/trial") == 2);
}

// The standard library of Debian 12 includes <cstdint> in many of its headers, that of Debian 13 no longer
// does.
TEST_CASE("a header that uses integers of a fixed size includes <cstdint>", "[layering]") {
  static const std::regex fixed_size("std::u?int(8|16|32|64)_t");
  std::set<std::string> users, includers;
  each_line(TURNPOINT_SOURCE_DIR, [&](const std::string& file, const std::string& line) {
    if (!file.ends_with(".hpp")) return;
    if (std::regex_search(line, fixed_size)) users.insert(file);
    if (line == "#include <cstdint>") includers.insert(file);
  });
  CHECK(users.size() > 50);
  for (const auto& file : users) {
    INFO(file);
    CHECK(includers.contains(file));
  }
}

TEST_CASE("negative control: an include that the table does not allow is found", "[layering]") {
  const auto table = table_of_the_tree();
  const auto breaks = [&](const char* file, const char* line) {
    return !violation(table, file, line).empty();
  };
  CHECK(breaks("physics/field.cpp", "#include \"station/rig/rig.hpp\""));
  CHECK(breaks("station/trial/machine.cpp", "#include \"station/store/read.hpp\""));
  CHECK(breaks("station/session/session.cpp", "#include <sqlite3.h>"));
  CHECK(breaks("station/session/session.cpp", "#include <QString>"));
  CHECK(breaks("station/audio/engine.cpp", "#include <alsa/asoundlib.h>"));
  CHECK(breaks("station/io/touch_reader.cpp", "#include <libevdev/libevdev.h>"));
  CHECK(breaks("station/nowhere/new.cpp", "int x = 0;"));
  CHECK_FALSE(breaks("station/audio/alsa_capture.cpp", "#include <alsa/asoundlib.h>"));
  CHECK_FALSE(breaks("station/scene/planner.cpp", "#include \"physics/field.hpp\""));
}

TEST_CASE("a name of a layer that the table does not allow is found without an include", "[layering]") {
  const auto table = table_of_the_tree();
  const auto breaks = [&](const char* line) {
    return !violation(table, "station/trial/machine.cpp", line).empty();
  };
  CHECK(breaks("  const auto rows = store::read_session(path, id);"));
  CHECK(breaks("  const auto rows = turnpoint::store::read_session(path, id);"));
  CHECK(breaks("std::vector<store::SessionRecord> all;"));
  CHECK(breaks("using namespace store;"));
  // opening a namespace, as a forward declaration does, counts too
  CHECK(breaks("namespace turnpoint::store {"));
  CHECK_FALSE(breaks("namespace turnpoint::trial {"));
  CHECK_FALSE(breaks("  return core::name(outcome);"));
  CHECK_FALSE(breaks("  log(\"store::read_session\");  // as store::read_session"));
  CHECK_FALSE(breaks("  return other::store::read();"));
  CHECK_FALSE(breaks("  store.read();"));
}

TEST_CASE("an entry of the table that nothing needs is found", "[layering]") {
  std::istringstream text("station/scene: station/core\nstation/core:\nphysics: station/scene\n");
  const auto table = parse_table(text);
  std::map<std::string, Layers> used;
  used["station/scene"] = used_by(table, "station/scene/a.cpp", "#include \"station/core/b.hpp\"");
  CHECK(unused(table, used) == std::vector<std::string>{"physics: station/scene"});
  used["station/scene"].clear();
  CHECK(unused(table, used).size() == 2);
}
