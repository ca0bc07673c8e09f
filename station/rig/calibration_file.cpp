#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "physics/boundary_budget.hpp"
#include "station/core/number.hpp"
#include "station/core/reader.hpp"
#include "station/rig/calibration.hpp"

// Helpers for reading and writing the tables of a calibration file.

namespace turnpoint::rig {

std::string quoted(const std::string& plain);

/// One line `key = [...]`, with one number for each point.
template <typename Points, typename Get>
std::string numbers_line(const char* key, const Points& points, Get&& get) {
  std::string out = fmt::format("{} = [", key);
  for (std::size_t k = 0; k < points.size(); ++k) out += (k ? ", " : "") + core::exact(get(points[k]));
  return out + "]\n";
}

/// Returns true if the columns have equal length; otherwise reports a problem.
bool same_length(core::TableReader& reader, const char* key, std::size_t length, std::size_t wanted);

/// Write and read the table [[pickup]] of a calibration file.
std::string pick_up_toml(const PickUp& pick_up);
PickUp read_pick_up(const core::Value& table, core::Findings& findings);

/// Write and read the table [forces] of a calibration file.
std::string forces_toml(const ForceCells& forces);
ForceCells read_forces(const core::Value& table, core::Findings& findings);

using core::phrase, core::plain;

using core::exact;
using core::Range;
using SensorEnds = core::Range::Ends;

std::string quoted(const std::string& plain) {
  std::string out = "\"";
  for (const char c : plain) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

bool same_length(core::TableReader& reader, const char* key, std::size_t length, std::size_t wanted) {
  if (length == wanted) return true;
  reader.problem(key, phrase("%1 values", {plain(length)}),
                 phrase("there must be %1 values, as in the other columns", {plain(wanted)}));
  return false;
}

std::string pick_up_toml(const PickUp& pick_up) {
  const auto& [channel, drive_channel, points] = pick_up.response;
  std::string out = fmt::format("\n[[pickup]]\nchannel = {}\ndrive_channel = {}\n", channel, drive_channel);
  if (pick_up.response_sd > 0) out += fmt::format("response_sd = {}\n", exact(pick_up.response_sd));
  if (const auto& scale = pick_up.scale) {
    out += fmt::format("sensor = \"{}\"\num_per_full_scale = {}\nat_Hz = {}\nexponent = {}\nscale_sd = {}\n",
                       name(scale->sensor), exact(scale->um_per_full_scale), exact(scale->at_Hz),
                       exact(scale->exponent), exact(scale->sd));
  }
  if (const auto& found = pick_up.resonances; !found.empty()) {
    out += numbers_line("resonance_Hz", found, [](const auto& r) { return r.frequency_Hz; });
    out += numbers_line("resonance_sd_Hz", found, [](const auto& r) { return r.frequency_sd_Hz; });
    out += numbers_line("quality_factor", found, [](const auto& r) { return r.quality_factor; });
    out += numbers_line("quality_sd", found, [](const auto& r) { return r.quality_sd; });
  }
  out += numbers_line("frequency_Hz", points, [](const auto& p) { return p.frequency_Hz; });
  out += numbers_line("amplitude", points, [](const auto& p) { return p.amplitude; });
  return out + numbers_line("phase_deg", points, [](const auto& p) { return p.phase_rad / kDegree_rad; });
}

namespace {

std::optional<PickUpScale> read_scale(core::TableReader& reader) {
  const auto sensor = reader.maybe_word("sensor", {"patch", "accelerometer"});
  if (!sensor) {
    for (const char* key : {"um_per_full_scale", "at_Hz", "exponent", "scale_sd"}) reader.take(key);
    return std::nullopt;
  }
  PickUpScale scale;
  scale.sensor = find_sensor(*sensor).value_or(PickUpSensor::patch);
  scale.um_per_full_scale = reader.number("um_per_full_scale", {0, 1e9, SensorEnds::open_low, "um"});
  scale.at_Hz = reader.number("at_Hz", {0, 1e6, SensorEnds::open_low, "Hz"});
  scale.exponent = reader.number("exponent", {-10, 10});
  scale.sd = reader.number("scale_sd", {0, 10});
  return scale;
}

std::vector<Resonance> read_resonances(core::TableReader& reader) {
  std::vector<Resonance> found;
  if (!reader.has("resonance_Hz")) {
    for (const char* key : {"resonance_sd_Hz", "quality_factor", "quality_sd"}) reader.take(key);
    reader.take("resonance_Hz");
    return found;
  }
  const Range positive{0, 1e9, SensorEnds::open_low};
  const auto f = reader.numbers("resonance_Hz", positive), f_sd = reader.numbers("resonance_sd_Hz", {0, 1e9}),
             q = reader.numbers("quality_factor", positive), q_sd = reader.numbers("quality_sd", {0, 1e9});
  if (same_length(reader, "resonance_sd_Hz", f_sd.size(), f.size()) &&
      same_length(reader, "quality_factor", q.size(), f.size()) &&
      same_length(reader, "quality_sd", q_sd.size(), f.size()))
    for (std::size_t k = 0; k < f.size(); ++k) found.push_back({f[k], q[k], f_sd[k], q_sd[k]});
  return found;
}

}  // namespace

PickUp read_pick_up(const core::Value& table, core::Findings& findings) {
  core::TableReader reader(table, "pickup", findings);
  PickUp pick_up;
  auto& response = pick_up.response;
  response.channel = reader.integer("channel", 0, 31);
  response.drive_channel = reader.integer("drive_channel", 0, 31);
  pick_up.response_sd = reader.maybe_number("response_sd", {0, 10}).value_or(0);
  pick_up.scale = read_scale(reader);
  pick_up.resonances = read_resonances(reader);
  const auto frequency = reader.numbers("frequency_Hz", {0, 1e6, SensorEnds::open_low, "Hz"}, 2);
  const auto amplitude = reader.numbers("amplitude", {0, 1e6}, 2);
  const auto phase = reader.numbers("phase_deg", {-1e6, 1e6}, 2);
  if (same_length(reader, "amplitude", amplitude.size(), frequency.size()) &&
      same_length(reader, "phase_deg", phase.size(), frequency.size()))
    for (std::size_t k = 0; k < frequency.size(); ++k) {
      if (k > 0 && frequency[k] <= frequency[k - 1])
        reader.problem("frequency_Hz", phrase("the values are not in ascending order"));
      response.points.push_back({frequency[k], amplitude[k], phase[k] * kDegree_rad});
    }
  reader.finish();
  return pick_up;
}

namespace {

std::vector<double> flat(const ForceCells::Matrix& matrix) {
  std::vector<double> all;
  for (const auto& row : matrix) all.insert(all.end(), row.begin(), row.end());
  return all;
}

ForceCells::Matrix matrix_of(const std::vector<double>& numbers, std::size_t first) {
  ForceCells::Matrix matrix{};
  for (std::size_t k = 0; k < 9; ++k) matrix[k / 3][k % 3] = numbers[first + k];
  return matrix;
}

constexpr auto itself = [](double number) { return number; };

}  // namespace

std::string forces_toml(const ForceCells& forces) {
  std::string out =
      fmt::format("\n[forces]                      # dead weights: N, N and N mm per {}\n",
                  forces.carrier_Hz > 0 ? "ratio of bridge to reference" : "unit of the converter");
  if (forces.carrier_Hz > 0)
    out += fmt::format("carrier_Hz = {}\nreference_amplitude = {}\n", exact(forces.carrier_Hz),
                       exact(forces.reference_amplitude));
  out += numbers_line("rotation_deg", forces.rotation_rad, [](double rad) { return rad / kDegree_rad; });
  out += numbers_line("rated_ratio", forces.rated_ratio, itself);
  if (forces.usable_Hz)
    out += fmt::format("usable_Hz = {}   # a third of the lowest resonance that a tap showed\n",
                       exact(*forces.usable_Hz));
  out += numbers_line("matrix", flat(forces.matrix), itself);
  std::vector<double> changes;
  for (const auto& change : forces.changes) {
    const auto all = flat(change);
    changes.insert(changes.end(), all.begin(), all.end());
  }
  return out + numbers_line("changes", changes, itself);
}

ForceCells read_forces(const core::Value& table, core::Findings& findings) {
  core::TableReader reader(table, "forces", findings);
  ForceCells forces;
  // Without a carrier, the cells have a converter with a clock of its own.
  if (reader.has("carrier_Hz") || reader.has("reference_amplitude")) {
    forces.carrier_Hz = reader.number("carrier_Hz", {0, 1e6, SensorEnds::open_low, "Hz"});
    forces.reference_amplitude = reader.number("reference_amplitude", {0, 1, SensorEnds::open_low});
  } else {
    for (const char* key : {"carrier_Hz", "reference_amplitude"}) reader.take(key);
  }
  const auto rotation = reader.numbers("rotation_deg", {-360, 360});
  const auto rated = reader.numbers("rated_ratio", {0, 1e3, SensorEnds::open_low});
  if (reader.has("usable_Hz"))
    forces.usable_Hz = reader.number("usable_Hz", {0, 1e3, SensorEnds::open_low, "Hz"});
  const auto matrix = reader.numbers("matrix", {-1e12, 1e12});
  const auto changes = reader.maybe_numbers("changes", {-1e12, 1e12});
  if (rotation.size() != 3) reader.problem("rotation_deg", phrase("needs one value for each of three cells"));
  if (rated.size() != 3) reader.problem("rated_ratio", phrase("needs one value for each of three cells"));
  if (matrix.size() != 9) reader.problem("matrix", phrase("needs nine values: three for each cell"));
  if (changes.size() % 9 != 0) reader.problem("changes", phrase("needs nine values for each change"));
  reader.finish();
  if (rotation.size() != 3 || rated.size() != 3 || matrix.size() != 9 || changes.size() % 9 != 0)
    return forces;
  for (std::size_t k = 0; k < 3; ++k) {
    forces.rotation_rad[k] = rotation[k] * kDegree_rad;
    forces.rated_ratio[k] = rated[k];
  }
  forces.matrix = matrix_of(matrix, 0);
  for (std::size_t first = 0; first < changes.size(); first += 9)
    forces.changes.push_back(matrix_of(changes, first));
  return forces;
}

namespace {

using Ends = core::Range::Ends;
constexpr double large = 1e300;

std::string boundary_toml(const BoundaryFit& fit) {
  std::string out =
      "\n[boundary]                    # measured boundaries, and the surface that fits them (SI units)\n";
  out += fmt::format("edge = {}\n", quoted(fit.edge));
  out += numbers_line("frequency_Hz", fit.points, [](const auto& p) { return p.frequency_Hz; });
  out += numbers_line("boundary_mm", fit.points, [](const auto& p) { return p.boundary_m * 1e3; });
  out += numbers_line("sd_mm", fit.points, [](const auto& p) { return p.sd_m * 1e3; });
  out += numbers_line("residual_mm", fit.points, [](const auto& p) { return p.residual_m * 1e3; });
  out += numbers_line("deviation", fit.points, [](const auto& p) { return p.deviation; });
  out += numbers_line("outlier", fit.points, [](const auto& p) { return p.outlier ? 1.0 : 0.0; });
  out += numbers_line("left_out", fit.points, [](const auto& p) { return p.left_out ? 1.0 : 0.0; });
  for (const auto& p : fit.surface.parameters) {
    out += fmt::format("\n[[boundary.parameter]]\nname = {}\nchange = {}\nsd = {}\nstated_sd = {}\n",
                       quoted(p.name), exact(p.change), exact(p.sd), exact(p.stated_sd));
    if (!p.correlations.empty())
      out += numbers_line("correlations", p.correlations, [](double r) { return r; });
  }
  return out;
}

std::string transducer_toml(const Calibration::Transducer& transducer) {
  const ResponseFit& fit = transducer.response;
  std::string out =
      fmt::format("\n[[transducer]]\nname = {}\nband_kHz = [{}, {}]\nresidual_dB = {}\nresidual_deg = {}\n",
                  quoted(transducer.name), exact(fit.low_Hz * 1e-3), exact(fit.high_Hz * 1e-3),
                  exact(fit.residual_dB), exact(fit.residual_rad / kDegree_rad));
  out += numbers_line("frequency_Hz", fit.points, [](const auto& p) { return p.frequency_Hz; });
  out +=
      numbers_line("um_per_full_scale", fit.points, [](const auto& p) { return p.m_per_full_scale * 1e6; });
  return out + numbers_line("phase_deg", fit.points, [](const auto& p) { return p.phase_rad / kDegree_rad; });
}

std::string delay_toml(const char* name, const std::optional<Delay>& delay) {
  if (!delay) return "";
  return fmt::format("{0}_s = {1}\n{0}_jitter_s = {2}\n{0}_pairs = {3}\n{0}_unmatched = {4}\n", name,
                     exact(delay->median_s), exact(delay->sd_s), delay->pairs, delay->unmatched);
}

std::string panel_toml(const PanelLatency& panel) {
  return fmt::format(
             "\n[panel]                       # median and SD of its latency\nmade_on = {}\nquality = {}\n",
             quoted(panel.made_on), quoted(panel.quality)) +
         delay_toml("response_offset", panel.touch) + delay_toml("flash", panel.flash);
}

std::optional<Delay> read_delay(core::TableReader& reader, const std::string& name) {
  const Range seconds{0, 1, Ends::closed, "s"};
  const auto median_s = reader.maybe_number(name + "_s", seconds);
  if (!median_s) return std::nullopt;
  Delay delay;
  delay.median_s = *median_s;
  delay.sd_s = reader.number(name + "_jitter_s", seconds);
  delay.pairs = reader.integer(name + "_pairs", 2, 1'000'000);
  delay.unmatched = reader.integer(name + "_unmatched", 0, 1'000'000);
  return delay;
}

PanelLatency read_panel(const core::Value& table, core::Findings& findings) {
  core::TableReader reader(table, "panel", findings);
  PanelLatency panel;
  panel.made_on = reader.string("made_on", phrase("write the date as YYYY-MM-DD"));
  panel.quality = reader.word("quality", {"kernel", "toolkit"});
  panel.touch = read_delay(reader, "response_offset");
  panel.flash = read_delay(reader, "flash");
  reader.finish();
  return panel;
}

Calibration::Transducer read_transducer(const core::Value& table, core::Findings& findings) {
  core::TableReader reader(table, core::titled("transducer", table), findings);
  Calibration::Transducer transducer;
  transducer.name = reader.string("name", phrase("write the name that the rig file gives to the transducer"));
  if (const auto band = reader.maybe_interval("band_kHz", {0, 1000, Ends::open_low, "kHz"})) {
    transducer.response.low_Hz = band->first * 1e3;
    transducer.response.high_Hz = band->second * 1e3;
  }
  transducer.response.residual_dB = reader.number("residual_dB", {0, large}, 0);
  transducer.response.residual_rad = reader.number("residual_deg", {0, large}, 0) * kDegree_rad;
  const auto frequency = reader.numbers("frequency_Hz", {0, 1e6, Ends::open_low, "Hz"}, 2);
  const auto response = reader.numbers("um_per_full_scale", {0, 1e6, Ends::open_low, "um"}, 2);
  const auto phase = reader.numbers("phase_deg", {-1e6, 1e6}, 2);
  if (same_length(reader, "um_per_full_scale", response.size(), frequency.size()) &&
      same_length(reader, "phase_deg", phase.size(), frequency.size()))
    for (std::size_t k = 0; k < frequency.size(); ++k) {
      if (k > 0 && frequency[k] <= frequency[k - 1])
        reader.problem("frequency_Hz", phrase("the values are not in ascending order"));
      transducer.response.points.push_back({frequency[k], response[k] * 1e-6, phase[k] * kDegree_rad});
    }
  reader.finish();
  return transducer;
}

SurfaceFit::Parameter read_parameter(const core::Value& table, std::size_t before, core::Findings& findings) {
  core::TableReader reader(table, core::titled("boundary.parameter", table), findings);
  SurfaceFit::Parameter parameter;
  parameter.name = reader.string("name", phrase("write the name of a parameter of the surface"));
  if (!physics::find_parameter(parameter.name))
    reader.problem("name", phrase("\"%1\" is not a parameter of a surface", {plain(parameter.name)}));
  parameter.change = reader.number("change", {-large, large});
  parameter.sd = reader.number("sd", {0, large});
  parameter.stated_sd = reader.number("stated_sd", {0, large, Ends::open_low});
  parameter.correlations = reader.maybe_numbers("correlations", {-1, 1});
  same_length(reader, "correlations", parameter.correlations.size(), before);
  reader.finish();
  return parameter;
}

BoundaryFit read_boundary(const core::Value& table, core::Findings& findings) {
  core::TableReader reader(table, "boundary", findings);
  BoundaryFit fit;
  fit.edge = reader.string("edge", phrase("write the edge that was measured"));
  const Range mm{-1e6, 1e6, Ends::closed, "mm"};
  const auto frequency = reader.numbers("frequency_Hz", {0, 1e6, Ends::open_low, "Hz"}),
             boundary = reader.numbers("boundary_mm", mm), sd = reader.numbers("sd_mm", mm),
             residual = reader.numbers("residual_mm", mm),
             deviation = reader.numbers("deviation", {-large, large}),
             outlier = reader.numbers("outlier", {0, 1}), left_out = reader.numbers("left_out", {0, 1});
  const auto n = frequency.size();
  if (same_length(reader, "boundary_mm", boundary.size(), n) && same_length(reader, "sd_mm", sd.size(), n) &&
      same_length(reader, "residual_mm", residual.size(), n) &&
      same_length(reader, "deviation", deviation.size(), n) &&
      same_length(reader, "outlier", outlier.size(), n) &&
      same_length(reader, "left_out", left_out.size(), n))
    for (std::size_t k = 0; k < n; ++k)
      fit.points.push_back({frequency[k], boundary[k] * 1e-3, sd[k] * 1e-3, residual[k] * 1e-3, deviation[k],
                            outlier[k] > 0, left_out[k] > 0});
  for (const core::Value* parameter : reader.tables("parameter"))
    fit.surface.parameters.push_back(read_parameter(*parameter, fit.surface.parameters.size(), findings));
  reader.finish();
  return fit;
}

void read_tables(core::TableReader& reader, Calibration& calibration) {
  core::Findings& findings = reader.findings();
  for (const core::Value* table : reader.tables("transducer"))
    calibration.transducers.push_back(read_transducer(*table, findings));
  for (const core::Value* table : reader.tables("pickup"))
    calibration.pick_ups.push_back(read_pick_up(*table, findings));
  if (const core::Value* table = reader.maybe_table("boundary"))
    calibration.boundary = read_boundary(*table, findings);
  if (const core::Value* table = reader.maybe_table("forces"))
    calibration.forces = read_forces(*table, findings);
  if (const core::Value* table = reader.maybe_table("panel"))
    calibration.panel = read_panel(*table, findings);
  if (const core::Value* table = reader.maybe_table("friction")) {
    core::TableReader inner(*table, "friction", findings);
    const auto u = inner.numbers("displacement_um", {0, 1e6}, 2);
    const auto mu = inner.numbers("relative_friction", {0, 1.5, Ends::open_low}, 2);
    FrictionFit fit;
    fit.residual = inner.number("residual", {0, 10}, 0);
    if (same_length(inner, "relative_friction", mu.size(), u.size()))
      for (std::size_t k = 0; k < u.size(); ++k) fit.points.push_back({u[k] * 1e-6, mu[k]});
    FrictionTable points;
    for (const auto& point : fit.points) points.emplace_back(point.displacement_m, point.relative_friction);
    if (rig::falling(points).empty())
      inner.problem("relative_friction",
                    phrase("displacements must be in ascending order from 0; friction must be 1 at "
                           "displacement 0, at least 0.001, never increase, and end below 1"));
    inner.finish();
    calibration.friction = fit;
  }
  if (const core::Value* table = reader.maybe_table("mixer")) {
    core::TableReader inner(*table, "mixer", findings);
    for (const auto& control : table->entries)
      calibration.mixer[control.key] = inner.string(control.key, phrase("write the values as text"));
    inner.finish();
  }
  if (const core::Value* table = reader.maybe_table("sound")) {
    core::TableReader inner(*table, "sound", findings);
    const auto f = inner.numbers("frequency_Hz", {0, 1e6, Ends::open_low}),
               level = inner.numbers("level_dB", {-100, 200});
    if (same_length(inner, "level_dB", level.size(), f.size()))
      for (std::size_t k = 0; k < f.size(); ++k) calibration.sound.push_back({f[k], level[k]});
    inner.finish();
  }
}

}  // namespace

std::string to_toml(const Calibration& c) {
  std::string out = "format = \"friction-calibration/1\"\n";
  out += fmt::format("rig = {}\nrig_sha256 = {}\nmade_on = {}\nvalid_days = {}\n", quoted(c.rig_name),
                     quoted(c.rig_sha256), quoted(c.made_on), c.valid_days);
  if (!c.note.empty()) out += fmt::format("note = {}\n", quoted(c.note));
  if (c.quality_factor) out += fmt::format("quality_factor = {}\n", exact(*c.quality_factor));
  if (c.boundary) out += boundary_toml(*c.boundary);
  if (c.friction) {
    out += "\n[friction]\n" + numbers_line("displacement_um", c.friction->points,
                                           [](const auto& p) { return p.displacement_m * 1e6; });
    out += numbers_line("relative_friction", c.friction->points,
                        [](const auto& p) { return p.relative_friction; });
    out += fmt::format("residual = {}\n", exact(c.friction->residual));
  }
  if (!c.sound.empty()) {
    out += "\n[sound]                       # dB SPL at full scale\n";
    out += numbers_line("frequency_Hz", c.sound, [](const auto& p) { return p.frequency_Hz; });
    out += numbers_line("level_dB", c.sound, [](const auto& p) { return p.level_dB; });
  }
  if (c.panel) out += panel_toml(*c.panel);
  for (const auto& transducer : c.transducers) out += transducer_toml(transducer);
  if (c.forces) out += forces_toml(*c.forces);
  for (const auto& pick_up : c.pick_ups) out += pick_up_toml(pick_up);
  if (!c.mixer.empty())
    out += "\n[mixer]                       # levels of the sound card during the measurements\n";
  for (const auto& [control, values] : c.mixer)
    out += fmt::format("{} = {}\n", quoted(control), quoted(values));
  return out;
}

Calibration load_calibration(const std::string& path) {
  return parse_calibration(core::read_text_file(path), path);
}

Calibration parse_calibration(const std::string& source, const std::string& path) {
  const core::Value document = core::parse_toml(source, path);
  core::Findings findings;
  core::TableReader reader(document, "", findings);
  Calibration calibration;
  reader.word("format", {"friction-calibration/1"});
  calibration.rig_name = reader.string("rig", phrase("write the rig's name"));
  calibration.rig_sha256 = reader.string("rig_sha256", phrase("write the rig file's SHA-256"));
  calibration.made_on = reader.string("made_on", phrase("write the date as YYYY-MM-DD"));
  calibration.valid_days = reader.integer("valid_days", 1, 3650);
  calibration.note = reader.maybe_string("note").value_or("");
  calibration.quality_factor = reader.maybe_number("quality_factor", {0, 1e9, Ends::open_low});
  read_tables(reader, calibration);
  reader.finish();
  findings.throw_if_any();
  return calibration;
}

}  // namespace turnpoint::rig
