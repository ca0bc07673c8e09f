#include "station/rig/spare_channels.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/rig/devices.hpp"

namespace turnpoint::rig {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;

namespace {

void check_spare(TableReader& reader, const std::string& key, int channel, const Rig& rig) {
  const auto number = std::to_string(channel);
  for (const auto& transducer : rig.transducers)
    if (transducer.channel == channel)
      reader.problem(key, phrase("channel %1 drives \"%2\"", {plain(number), plain(transducer.name)}),
                     phrase("use a channel without a transducer"));
  const bool marker = rig.marker && rig.marker->channel == channel;
  if (marker || (rig.noise && rig.noise->channel == channel))
    reader.problem(key,
                   marker ? phrase("channel %1 is used by the marker", {plain(number)})
                          : phrase("channel %1 is used by the noise", {plain(number)}),
                   phrase("use a channel of its own"));
}

double highest_Hz(const Rig& rig) { return core::kHighestShareOfRate * std::max(rig.output.rate_Hz, 8000); }

Marker read_marker(const core::Value& table, const Rig& rig, TableReader& file) {
  TableReader reader(table, "marker", file.findings(), file.keys("marker"));
  Marker marker;
  marker.channel = reader.integer("channel");
  check_spare(reader, "channel", marker.channel, rig);
  const auto kind = reader.word("kind");
  marker.kind = kind == "tone"   ? Marker::Kind::tone
                : kind == "code" ? Marker::Kind::code
                                 : Marker::Kind::pulse;
  marker.amplitude = reader.number("amplitude");
  marker.duration_s = 1e-3 * reader.number("duration_ms");
  if (kind == "tone")
    marker.frequency_Hz = reader.number("frequency_Hz", {0, highest_Hz(rig), Range::Ends::open_low, "Hz"});
  reader.finish();
  return marker;
}

MaskingNoise read_noise(const core::Value& table, const Rig& rig, TableReader& file) {
  TableReader reader(table, "noise", file.findings(), file.keys("noise"));
  MaskingNoise noise;
  noise.channel = reader.integer("channel");
  check_spare(reader, "channel", noise.channel, rig);
  noise.rms = reader.number("rms");
  if (const auto band = reader.maybe_interval("band_Hz", {0, highest_Hz(rig), Range::Ends::open_low, "Hz"}))
    noise.low_Hz = band->first, noise.high_Hz = band->second;
  else if (!reader.has("band_Hz"))
    reader.defaulted("band_Hz", "[100, 8000]");
  if (const auto* signal = reader.maybe_table("signal")) {
    TableReader tone(*signal, "noise.signal", file.findings(), reader.keys("signal"));
    noise.signal = MaskingNoise::Signal{};
    noise.signal->frequency_Hz =
        tone.number("frequency_Hz", {20, std::min(20e3, highest_Hz(rig)), Range::Ends::closed, "Hz"});
    noise.signal->amplitude = tone.number("amplitude");
    tone.finish();
  }
  reader.finish();
  return noise;
}

void read_loop(TableReader& reader, const Rig& rig, Capture& capture) {
  capture.reference = reader.integer("reference");
  const auto& pick_ups = capture.pick_ups;
  if (capture.reference >= capture.channels)
    reader.problem("reference", phrase("channel %1 is not captured", {plain(capture.reference)}),
                   phrase("a whole number from 0 to %1", {plain(capture.channels - 1)}));
  else if (std::find(pick_ups.begin(), pick_ups.end(), capture.reference) != pick_ups.end())
    reader.problem("reference", phrase("channel %1 is also in \"pickups\"", {plain(capture.reference)}),
                   phrase("use a channel of its own"));
  capture.excitation_channel = reader.integer("excitation_channel");
  check_spare(reader, "excitation_channel", *capture.excitation_channel, rig);
}

/// Reports a captured channel that does not exist or that is used for something else.
void check_captured(TableReader& reader, const std::string& key, int channel, const Capture& capture) {
  const auto& pick_ups = capture.pick_ups;
  const auto number = std::to_string(channel);
  if (channel >= capture.channels)
    reader.problem(key, phrase("channel %1 is not captured", {plain(number)}),
                   phrase("a whole number from 0 to %1", {plain(capture.channels - 1)}));
  else if (std::find(pick_ups.begin(), pick_ups.end(), channel) != pick_ups.end() ||
           (capture.excitation_channel && capture.reference == channel) ||
           std::find(capture.bridges.begin(), capture.bridges.end(), channel) != capture.bridges.end())
    reader.problem(key, phrase("channel %1 is also captured for something else", {plain(number)}),
                   phrase("use a channel of its own"));
}

void read_bridges(TableReader& reader, Capture& capture) {
  const auto channels = reader.numbers("bridges");
  for (const double number : channels) {
    const int channel = static_cast<int>(number);
    const auto same = std::count(channels.begin(), channels.end(), number);
    if (channels.size() != 3 || number != channel || same > 1) {
      reader.problem(
          "bridges", phrase("\"bridges\" needs the channels of three cells"),
          phrase("write three different whole numbers: two cells below the surface, and the lateral cell"));
      return;
    }
    check_captured(reader, "bridges", channel, capture);
    capture.bridges.push_back(channel);
  }
  capture.cells_resonance_Hz = reader.maybe_number("cells_resonance_Hz");
  if (capture.cells_resonance_Hz) capture.cells_damping = reader.number("cells_damping");
}

void read_marker_channel(TableReader& reader, const Rig& rig, Capture& capture) {
  capture.marker_channel = reader.maybe_integer("marker_channel");
  if (!capture.marker_channel) return;
  check_captured(reader, "marker_channel", *capture.marker_channel, capture);
  if (!rig.marker || rig.marker->kind != Marker::Kind::code)
    reader.problem("marker_channel", phrase("the rig has no marker with codes"),
                   phrase("add [marker] with %1, or leave this out", {plain("kind = \"code\"")}));
}

Sync read_sync(const core::Value& table, const Rig& rig, TableReader& file) {
  TableReader reader(table, "sync", file.findings(), file.keys("sync"));
  Sync sync;
  sync.uri = read_uri(reader);
  check_gpio(reader, sync.uri, {"line"}, {"active"});
  if (sync.uri == "capture:") {
    sync.channel = reader.integer("channel");
    if (!rig.capture)
      reader.problem("uri", phrase("the rig captures nothing"),
                     phrase("add [capture], or use %1", {plain("\"gpio:line=LINE\"")}));
    else
      check_captured(reader, "channel", *sync.channel, *rig.capture);
  }
  reader.finish();
  return sync;
}

Capture read_capture(const core::Value& table, const Rig& rig, TableReader& file) {
  TableReader reader(table, "capture", file.findings(), file.keys("capture"));
  Capture capture;
  capture.uri = read_uri(reader);
  capture.channels = reader.integer("channels");
  std::set<double> seen;
  for (const double channel : reader.numbers("pickups")) {
    if (channel != std::floor(channel) || channel >= capture.channels || !seen.insert(channel).second)
      reader.problem(
          "pickups",
          phrase("channel %1 is not a captured channel of its own", {plain(core::number(channel))}),
          phrase("write different whole numbers from 0 to %1", {plain(capture.channels - 1)}));
    capture.pick_ups.push_back(static_cast<int>(channel));
  }
  const bool has_bridges = reader.has("bridges");
  if (has_bridges || capture.uri.starts_with("alsa:")) read_loop(reader, rig, capture);
  if (has_bridges) read_bridges(reader, capture);
  read_marker_channel(reader, rig, capture);
  reader.finish();
  return capture;
}

CellConverter read_converter(const core::Value& table, Rig& rig, TableReader& file) {
  TableReader reader(table, "force_cells", file.findings(), file.keys("force_cells"));
  CellConverter converter;
  converter.uri = read_uri(reader);
  const std::array keys{"a", "b", "lateral"};
  for (std::size_t k = 0; k < keys.size(); ++k) {
    auto& name = converter.channels[k];
    name = reader.string(keys[k]);
    for (std::size_t other = 0; other < k; ++other)
      if (!name.empty() && converter.channels[other] == name)
        reader.problem(keys[k],
                       phrase("channel \"%1\" is also that of \"%2\"", {plain(name), plain(keys[other])}),
                       phrase("a channel of its own for each cell"));
  }
  converter.rate_Hz = reader.number("rate_Hz");
  converter.sampling_frequency = reader.maybe_number("sampling_frequency");
  converter.trigger = reader.maybe_string("trigger").value_or("");
  converter.delay_s = 1e-3 * reader.number("delay_ms");
  reader.finish();
  if (!rig.capture || !rig.capture->uri.starts_with("alsa:"))
    reader.problem("uri", phrase("force cells on a converter need pick-ups on the card that plays"),
                   phrase("add [capture] with %1", {plain("uri = \"alsa:NAME\"")}));
  else if (!rig.capture->bridges.empty())
    reader.problem("uri", phrase("[capture] already has force cells"),
                   phrase("leave out \"bridges\" or [force_cells]"));
  return converter;
}

}  // namespace

bool has_force_cells(const Rig& rig) {
  return rig.capture && (!rig.capture->bridges.empty() || rig.capture->converter);
}

void read_spare_channels(TableReader& file, Rig& rig) {
  if (const auto* table = file.maybe_table("marker")) rig.marker = read_marker(*table, rig, file);
  if (const auto* table = file.maybe_table("noise")) rig.noise = read_noise(*table, rig, file);
  if (const auto* table = file.maybe_table("capture")) rig.capture = read_capture(*table, rig, file);
  if (const auto* table = file.maybe_table("force_cells")) {
    const auto converter = read_converter(*table, rig, file);
    if (rig.capture) rig.capture->converter = converter;
  }
  if (const auto* table = file.maybe_table("sync")) rig.sync = read_sync(*table, rig, file);
}

int largest_trigger_code(const Rig& rig) {
  const bool marked = rig.marker && rig.marker->kind == Marker::Kind::code;
  if (!rig.trigger_lines_uri) return marked ? 255 : 0;
  int bits = rig.trigger_lines_uri->starts_with("gpio:") ? 0 : 8;
  while (bits < 8 && rig.trigger_lines_uri->find("bit" + std::to_string(bits) + "=") != std::string::npos)
    ++bits;
  return (1 << bits) - 1;
}

int channels(const Rig& rig) {
  int last = 1;
  for (const auto& transducer : rig.transducers) last = std::max(last, transducer.channel);
  if (rig.marker) last = std::max(last, rig.marker->channel);
  if (rig.noise) last = std::max(last, rig.noise->channel);
  if (rig.capture) last = std::max(last, rig.capture->excitation_channel.value_or(0));
  return last + 1;
}

std::vector<std::string> unproven_transducers(const Rig& rig) {
  std::vector<std::string> names;
  if (!rig.capture || !rig.capture->excitation_channel) return names;
  const auto& responses = rig.capture->responses;
  for (const auto& transducer : rig.transducers)
    if (std::none_of(responses.begin(), responses.end(),
                     [&](const auto& response) { return response.drive_channel == transducer.channel; }))
      names.push_back(transducer.name);
  return names;
}

}  // namespace turnpoint::rig
