#include "station/session/places.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <tuple>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::session {

namespace fs = std::filesystem;

std::string shipped(const std::string& folder) {
  const auto program = fs::read_symlink("/proc/self/exe").parent_path();
  // An installed program is in PREFIX/bin, and its folders are in PREFIX/share/turnpoint. In a source tree
  // the program is in build/<preset>/bin.
  const auto installed = program.parent_path() / "share/turnpoint" / fs::path(folder).filename();
  if (fs::is_directory(installed)) return installed.lexically_normal().string();
  return (program.parent_path().parent_path().parent_path() / folder).lexically_normal().string();
}

std::string file_or_shipped(const std::string& named, const std::string& folder) {
  std::error_code ignored;
  if (named.empty() || named.find('/') != std::string::npos || fs::exists(named, ignored)) return named;
  const auto name = named.ends_with(".toml") ? named.substr(0, named.size() - 5) : named;
  std::vector<std::string> known;
  for (const auto& entry : fs::directory_iterator(shipped(folder), ignored)) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().stem() == name) return entry.path().string();
    known.push_back(entry.path().stem().string());
  }
  std::sort(known.begin(), known.end());
  const auto near = core::nearest(name, known);
  std::string all;
  for (const auto& one : known) all += (all.empty() ? "" : ", ") + one;
  throw core::UsageError(named + ": there is no such file, and none of this name comes with the program" +
                         (near.empty() ? "; " : "; did you mean " + near + "? ") + "the names are " + all);
}

std::string rig_or_default(const std::string& named, std::ostream& messages) {
  if (!named.empty()) return named;
  const fs::path candidates[] = {"/etc/turnpoint/rig.toml",
                                 fs::path(shipped("deploy/rigs")) / "simulated.toml"};
  for (const auto& candidate : candidates)
    if (fs::exists(candidate)) {
      messages << "rig: " << candidate.string() << " (no --rig was given)\n";
      return candidate.string();
    }
  throw core::BadInput({{{}, core::phrase("refusal.no_rig"), core::phrase("refusal.name_rig")}});
}

std::string screen_card(const std::string& drm) {
  // Each card with its sort key: cards with a screen come first, then cards with a shorter name, then cards
  // with the lower number.
  std::vector<std::tuple<bool, std::size_t, std::string>> cards;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(drm, ignored)) {
    const auto connector = entry.path().filename().string();  // name of a connector, such as card1-HDMI-A-1
    const auto dash = connector.find('-');
    if (dash == std::string::npos || !connector.starts_with("card")) continue;
    std::string status;
    std::ifstream(entry.path() / "status") >> status;
    cards.emplace_back(status != "connected", dash, "/dev/dri/" + connector.substr(0, dash));
  }
  return cards.empty() ? "" : std::get<std::string>(*std::min_element(cards.begin(), cards.end()));
}

std::string default_database() {
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const auto set = [](const char* value) { return value != nullptr && *value != '\0'; };
  if (!set(data) && !set(home))
    throw core::UsageError(
        "HOME is not set, so there is no data folder; set HOME, or name the place with --db (with --data for "
        "turnpoint doctor)");
  const fs::path root = set(data) ? fs::path(data) : fs::path(home) / ".local/share";
  return (root / "turnpoint" / "turnpoint.sqlite").string();
}

}  // namespace turnpoint::session
