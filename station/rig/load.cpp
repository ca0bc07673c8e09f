#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/rig/csv.hpp"
#include "station/rig/devices.hpp"
#include "station/rig/rig.hpp"
#include "station/rig/rig_keys.hpp"
#include "station/rig/spare_channels.hpp"
#include "station/rig/surface.hpp"

namespace turnpoint::rig {

using core::phrase, core::plain;

namespace {

/// True if a point may be the next of a friction table.
bool may_follow(const FrictionTable& table, double displacement_m, double friction) {
  const bool first = table.empty();
  const bool ascends = first ? displacement_m >= 0 : displacement_m >= table.back().first + kLeastStep_m;
  const double most = first ? 1 : table.back().second;
  return ascends && friction >= kLeastFriction && friction <= most && (displacement_m > 0 || friction == 1);
}

}  // namespace

FrictionTable falling(const FrictionTable& table) {
  constexpr double equal = 1e-9;
  FrictionTable checked, curve{{0, 1}};
  for (const auto& [displacement_m, friction] : table) {
    if (!may_follow(checked, displacement_m, friction)) return {};
    checked.emplace_back(displacement_m, friction);
  }
  for (std::size_t i = 0, end = 0; i < table.size(); i = end) {
    while (end < table.size() && table[end].second >= table[i].second - equal) ++end;
    if (table[i].second < 1 - equal)
      curve.emplace_back((table[i].first + table[end - 1].first) / 2, table[i].second);
  }
  return curve.size() < 2 ? FrictionTable{} : curve;
}

namespace {

using core::Findings;
using core::TableReader;
constexpr double pi = 3.14159265358979323846;

std::string beside(const std::string& path, const std::string& file) {
  const std::filesystem::path named(file);
  return named.is_absolute() ? file : (std::filesystem::path(path).parent_path() / named).string();
}

void read_response(TableReader& reader, const std::string& rig_path, Transducer& transducer) {
  const auto file = reader.maybe_string("response_csv");
  const auto um = reader.maybe_number("um_per_full_scale");
  if (um) transducer.m_per_full_scale = 1e-6 * *um;
  if (!file) return;
  const auto csv = beside(rig_path, *file);
  const auto place = reader.place("response_csv");
  const auto rows =
      read_table(csv, {"frequency_Hz", "um_per_full_scale", "phase_deg"}, place, reader.findings());
  for (const auto& row : rows) {
    const auto& points = transducer.response;
    if (row[0] <= (points.empty() ? 0 : points.back().frequency_Hz) || row[1] <= 0)
      return reader.findings().add(
          place,
          phrase("%1 has a row %2 Hz with a value that is not allowed",
                 {plain(csv), plain(core::number(row[0]))}),
          phrase("frequencies must be above 0 and in ascending order; um_per_full_scale must be above 0"));
    transducer.response.push_back({row[0], 1e-6 * row[1], row[2] * pi / 180});
  }
}

Transducer read_transducer(const core::Value& table, const std::string& rig_path, TableReader& file) {
  TableReader reader(table, titled("transducer", table), file.findings(), file.keys("transducer"));
  Transducer transducer;
  transducer.name = reader.string("name");
  transducer.channel = reader.integer("channel");
  reader.require("band_kHz");
  if (const auto band = reader.maybe_interval("band_kHz")) {
    transducer.low_Hz = 1e3 * band->first;
    transducer.high_Hz = 1e3 * band->second;
  }
  read_response(reader, rig_path, transducer);
  const auto& response = transducer.response;
  if (response.size() >= 2 && transducer.high_Hz > 0 &&
      (transducer.low_Hz < response.front().frequency_Hz ||
       transducer.high_Hz > response.back().frequency_Hz))
    reader.problem("band_kHz", phrase("the band extends beyond the measured response"),
                   phrase("it must lie within %1 to %2 kHz",
                          {plain(core::number(1e-3 * response.front().frequency_Hz)),
                           plain(core::number(1e-3 * response.back().frequency_Hz))}));
  reader.finish();
  return transducer;
}

void read_transducers(TableReader& file, Rig& rig) {
  const auto tables = file.tables("transducer");
  if (tables.empty() && !file.has("transducer"))
    file.findings().add({rig.path, 0, 0}, phrase("the file has no [[transducer]] table"),
                        phrase("add one table for each drive element"));
  std::set<std::string> names;
  std::set<int> channels;
  for (const auto* table : tables) {
    rig.transducers.push_back(read_transducer(*table, rig.path, file));
    const auto& transducer = rig.transducers.back();
    if (!transducer.name.empty() && !names.insert(transducer.name).second)
      file.findings().add(table->place,
                          phrase("there is already a transducer named \"%1\"", {plain(transducer.name)}),
                          phrase("each transducer needs a different name"));
    if (table->find("channel") && !channels.insert(transducer.channel).second)
      file.findings().add(table->find("channel")->value.place,
                          phrase("channel %1 is used by two transducers", {plain(transducer.channel)}),
                          phrase("give each transducer its own channel"));
  }
}

void read_output(TableReader& file, Rig& rig) {
  const auto* table = file.table("output");
  if (!table) return;
  TableReader reader(*table, "output", file.findings(), file.keys("output"));
  auto& output = rig.output;
  output.uri = read_uri(reader);
  output.rate_Hz = reader.integer("rate_Hz");
  output.bits = reader.integer("bits");
  output.period_frames = reader.integer("period_frames");
  output.periods = reader.integer("periods");
  output.converter_delay_s = 1e-3 * reader.number("converter_delay_ms");
  output.device_channels = reader.maybe_integer("device_channels").value_or(output.device_channels);
  if (const double period_s = static_cast<double>(output.period_frames) / std::max(output.rate_Hz, 1);
      output.rate_Hz > 0 && period_s > longest_period_s)
    reader.problem(
        "period_frames",
        phrase("a period lasts %1 ms; the amplifier's guard would conclude that the audio thread has stopped",
               {plain(core::number(1e3 * period_s, 3))}),
        phrase("at most %1 ms: %2 frames",
               {plain(core::number(1e3 * longest_period_s)),
                plain(core::number(std::floor(longest_period_s * output.rate_Hz)))}));
  if (!reader.has("allow_plugin")) reader.defaulted("allow_plugin", "[]");
  output.allow_plugin = reader.maybe_strings("allow_plugin");
  reader.finish();
}

void check_device_channels(TableReader& file, const Rig& rig) {
  const auto* table = file.maybe_table("output");
  const auto* given = table == nullptr ? nullptr : table->find("device_channels");
  if (given == nullptr || rig.output.device_channels >= channels(rig)) return;
  file.findings().add(
      given->value.place, phrase("device_channels is %1", {plain(rig.output.device_channels)}),
      phrase("at least %1, the number of channels that the rig uses", {plain(channels(rig))}));
}

void check_bands(TableReader& file, const Rig& rig) {
  if (rig.output.rate_Hz <= 0) return;
  // Above 0.45 of the sampling rate the level depends on the converter's filter, which the rig file does not
  // describe.
  const double limit_Hz = core::kHighestShareOfRate * rig.output.rate_Hz;
  for (const auto* table : file.tables("transducer")) {
    const auto* band = table->find("band_kHz");
    if (!band || band->value.items.size() != 2 || band->value.items[1].number * 1e3 <= limit_Hz) continue;
    file.findings().add(band->value.place,
                        phrase("the band ends at %1 kHz", {plain(core::number(band->value.items[1].number))}),
                        phrase("it may extend at most to 0.45 of rate_Hz, which is %1 kHz",
                               {plain(core::number(1e-3 * limit_Hz))}));
  }
}

void read_friction_table(TableReader& reader, const std::string& file, Rig& rig) {
  const auto csv = beside(rig.path, file);
  const auto place = reader.place("table_csv");
  auto& table = rig.friction.table;
  for (const auto& row :
       read_table(csv, {"displacement_um", "relative_friction"}, place, reader.findings())) {
    if (!may_follow(table, 1e-6 * row[0], row[1]))
      return reader.findings().add(
          place,
          phrase("%1 has a row %2 um with a value that is not allowed",
                 {plain(csv), plain(core::number(row[0]))}),
          phrase("displacements must be in ascending order from 0; friction must be 1 at displacement 0, at "
                 "least 0.001, never increase, and end below 1"));
    table.emplace_back(1e-6 * row[0], row[1]);
  }
  if (!table.empty() && falling(table).empty())
    reader.findings().add(place,
                          phrase("%1 has a row %2 um with a value that is not allowed",
                                 {plain(csv), plain(core::number(1e6 * table.back().first))}),
                          phrase("displacements must be in ascending order from 0; friction must be 1 at "
                                 "displacement 0, at least 0.001, never increase, and end below 1"));
  rig.friction.measured = true;
}

void read_friction(TableReader& file, Rig& rig) {
  static const core::Value empty;
  const auto* table = file.maybe_table("friction");
  rig.friction.stated = table != nullptr;
  TableReader reader(table ? *table : empty, "friction", file.findings(), file.keys("friction"));
  auto& friction = rig.friction;
  if (const auto csv = reader.maybe_string("table_csv")) read_friction_table(reader, *csv, rig);
  if (!reader.has("table_csv")) {
    reader.word("model");
    friction.pressure_Pa = 1e3 * reader.number("pressure_kPa");
    friction.floor = reader.number("floor");
  }
  friction.fingertip_m = 1e-3 * reader.number("fingertip_mm");
  reader.finish();
}

void read_finger(TableReader& file, Rig& rig) {
  static const core::Value empty;
  const auto* table = file.maybe_table("finger");
  TableReader reader(table ? *table : empty, "finger", file.findings(), file.keys("finger"));
  constexpr double degree = pi / 180;
  auto& finger = rig.finger;
  finger.impedance_Ns_per_m = reader.number("impedance_Ns_per_m");
  finger.impedance_sd_Ns_per_m = reader.number("impedance_sd_Ns_per_m");
  finger.phase_rad = degree * reader.number("phase_deg");
  finger.phase_sd_rad = degree * reader.number("phase_sd_deg");
  finger.contact_m = 1e-3 * reader.number("contact_mm");
  finger.skin_m_per_N = 1e-3 * reader.number("skin_mm_per_N");
  reader.finish();
}

void read_limits(TableReader& file, Rig& rig) {
  const auto* table = file.table("limits");
  if (!table) return;
  TableReader reader(*table, "limits", file.findings(), file.keys("limits"));
  rig.limits.displacement_m = 1e-6 * reader.number("displacement_um");
  rig.limits.continuous_s = reader.number("continuous_s");
  rig.limits.duty = reader.number("duty");
  rig.limits.session_minutes = reader.number("session_minutes");
  reader.finish();
}

}  // namespace

Rig parse(const std::string& source, const std::string& path) {
  const auto document = core::parse_toml(source, path);
  Findings findings;
  Rig rig;
  rig.path = path, rig.source = source, rig.sha256 = core::sha256(source);
  TableReader file(document, "", findings, rig_keys());
  file.word("format");
  rig.name = file.string("name");
  rig.reproduction = file.boolean("reproduction");
  if (const auto* surface = file.table("surface")) rig.surface = read_surface(*surface, file);
  read_transducers(file, rig);
  read_output(file, rig);
  check_bands(file, rig);
  read_devices(file, rig);
  read_spare_channels(file, rig);
  check_device_channels(file, rig);
  read_friction(file, rig);
  read_finger(file, rig);
  read_limits(file, rig);
  file.finish();
  findings.throw_if_any();
  rig.defaults_used = findings.defaults_used;
  return rig;
}

Rig load(const std::string& path) { return parse(core::read_text_file(path), path); }

}  // namespace turnpoint::rig
