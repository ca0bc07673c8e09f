#include <algorithm>
#include <utility>

#include "station/calibration/calibration_tables.hpp"

namespace turnpoint::calibration {

using texts::phrase, texts::plain;

using text::exact;
using text::Range;
using SensorEnds = text::Range::Ends;

std::string quoted(const std::string& plain) {
  std::string out = "\"";
  for (const char c : plain) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

bool same_length(text::TableReader& reader, const char* key, std::size_t length, std::size_t wanted) {
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
    out += numbers("resonance_Hz", found, [](const auto& r) { return r.frequency_Hz; });
    out += numbers("resonance_sd_Hz", found, [](const auto& r) { return r.frequency_sd_Hz; });
    out += numbers("quality_factor", found, [](const auto& r) { return r.quality_factor; });
    out += numbers("quality_sd", found, [](const auto& r) { return r.quality_sd; });
  }
  out += numbers("frequency_Hz", points, [](const auto& p) { return p.frequency_Hz; });
  out += numbers("amplitude", points, [](const auto& p) { return p.amplitude; });
  return out + numbers("phase_deg", points, [](const auto& p) { return p.phase_rad / kDegree_rad; });
}

namespace {

std::optional<PickUpScale> read_scale(text::TableReader& reader) {
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

std::vector<Resonance> read_resonances(text::TableReader& reader) {
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

PickUp read_pick_up(const text::Value& table, text::Findings& findings) {
  text::TableReader reader(table, "pickup", findings);
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

std::vector<double> flat(const rig::ForceCells::Matrix& matrix) {
  std::vector<double> all;
  for (const auto& row : matrix) all.insert(all.end(), row.begin(), row.end());
  return all;
}

rig::ForceCells::Matrix matrix_of(const std::vector<double>& numbers, std::size_t first) {
  rig::ForceCells::Matrix matrix{};
  for (std::size_t k = 0; k < 9; ++k) matrix[k / 3][k % 3] = numbers[first + k];
  return matrix;
}

constexpr auto same = [](double number) { return number; };

}  // namespace

std::string forces_toml(const rig::ForceCells& forces) {
  std::string out =
      fmt::format("\n[forces]                      # dead weights: N, N and N mm per {}\n",
                  forces.carrier_Hz > 0 ? "ratio of bridge to reference" : "unit of the converter");
  if (forces.carrier_Hz > 0)
    out += fmt::format("carrier_Hz = {}\nreference_amplitude = {}\n", exact(forces.carrier_Hz),
                       exact(forces.reference_amplitude));
  out += numbers("rotation_deg", forces.rotation_rad, [](double rad) { return rad / kDegree_rad; });
  out += numbers("rated_ratio", forces.rated_ratio, same);
  if (forces.usable_Hz)
    out += fmt::format("usable_Hz = {}   # a third of the lowest resonance that a tap showed\n",
                       exact(*forces.usable_Hz));
  out += numbers("matrix", flat(forces.matrix), same);
  std::vector<double> changes;
  for (const auto& change : forces.changes) {
    const auto all = flat(change);
    changes.insert(changes.end(), all.begin(), all.end());
  }
  return out + numbers("changes", changes, same);
}

rig::ForceCells read_forces(const text::Value& table, text::Findings& findings) {
  text::TableReader reader(table, "forces", findings);
  rig::ForceCells forces;
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

}  // namespace turnpoint::calibration
