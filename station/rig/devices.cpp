#include "station/rig/devices.hpp"

#include <algorithm>
#include <set>

namespace turnpoint::rig {

using core::phrase, core::plain;

using core::TableReader;

std::string read_uri(TableReader& reader) {
  const auto& forms = reader.words("uri");
  const auto allowed = core::quoted_list(forms);
  const auto uri = reader.string("uri", allowed);
  if (uri.empty()) return uri;
  for (const auto& form : forms) {
    const auto scheme = form.substr(0, form.find(':') + 1);
    if (scheme == form ? uri == form : uri.starts_with(scheme) && uri.size() > scheme.size()) return uri;
  }
  reader.problem("uri", phrase("\"%1\" is \"%2\"", {plain("uri"), plain(uri)}),
                 phrase("allowed: %1", {allowed}));
  return uri;
}

void check_gpio(TableReader& reader, const std::string& uri, const std::vector<std::string>& needed,
                const std::vector<std::string>& optional) {
  if (uri.rfind("gpio:", 0) != 0) return;
  std::set<std::string> seen;
  std::string rest = uri.substr(5);
  auto all = needed;
  all.insert(all.end(), optional.begin(), optional.end());
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    const auto part = rest.substr(0, comma);
    rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
    const auto equals = part.find('=');
    const auto name = part.substr(0, equals);
    const bool known = std::find(all.begin(), all.end(), name) != all.end();
    if (!known || equals == std::string::npos || equals + 1 == part.size() || !seen.insert(name).second)
      return reader.problem("uri", phrase("\"%1\" in \"%2\" does not name a line", {plain(part), plain(uri)}),
                            phrase("each of %1 once, as name=LINE", {core::quoted_list(all)}));
  }
  for (const auto& name : needed)
    if (!seen.count(name))
      return reader.problem("uri", phrase("\"%1\" has no line \"%2\"", {plain(uri), plain(name)}),
                            phrase("needed: %1", {core::quoted_list(needed)}));
}

namespace {

std::optional<std::string> read_device(TableReader& file, const std::string& key,
                                       const std::vector<std::string>& lines,
                                       const std::vector<std::string>& optional_lines = {}) {
  const auto* table = file.maybe_table(key);
  if (!table) return std::nullopt;
  TableReader reader(*table, key, file.findings(), file.keys(key));
  const auto uri = read_uri(reader);
  check_gpio(reader, uri, lines, optional_lines);
  reader.finish();
  return uri;
}

std::optional<Thermometers> read_thermometers(TableReader& file) {
  const auto* table = file.maybe_table("temperature");
  if (!table) return std::nullopt;
  TableReader reader(*table, "temperature", file.findings(), file.keys("temperature"));
  Thermometers made;
  made.plate_uri = reader.string("plate");
  made.frame_uri = reader.string("frame");
  reader.finish();
  return made;
}

}  // namespace

void read_devices(TableReader& file, Rig& rig) {
  file.require("amplifier");
  rig.amplifier_uri = read_device(file, "amplifier", {"enable"},
                                  {"fault", "stop", "heartbeat", "gate", "read_back", "active",
                                   "fault_active", "stop_active"})
                          .value_or("");
  rig.buttons_uri =
      read_device(file, "buttons", {"left", "right"}, {"third", "active", "hold_ms", "refractory_ms"});
  rig.contact_uri = read_device(file, "contact", {"line"}, {"active", "hold_ms", "refractory_ms"});
  rig.trigger_lines_uri =
      read_device(file, "trigger_lines", {"bit0"},
                  {"bit1", "bit2", "bit3", "bit4", "bit5", "bit6", "bit7", "strobe", "pulse_ms"});
  rig.touch_uri = read_device(file, "touch", {});
  rig.thermometers = read_thermometers(file);
}

}  // namespace turnpoint::rig
