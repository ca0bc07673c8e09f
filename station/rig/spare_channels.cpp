#include "station/rig/spare_channels.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "station/rig/devices.hpp"
#include "station/terms/limits.hpp"
#include "station/text/number.hpp"

namespace turnpoint::rig {

using text::Range;
using text::TableReader;

namespace {

void check_spare(TableReader& reader, const std::string& key, int channel, const Rig& rig) {
  const auto what = "channel " + std::to_string(channel);
  for (const auto& transducer : rig.transducers)
    if (transducer.channel == channel)
      reader.problem(key, what + " drives \"" + transducer.name + "\"", "use a channel without a transducer");
  const bool marker = rig.marker && rig.marker->channel == channel;
  if (marker || (rig.noise && rig.noise->channel == channel))
    reader.problem(key, what + " is used by the " + (marker ? "marker" : "noise"),
                   "use a channel of its own");
}

double highest_Hz(const Rig& rig) { return terms::kHighestShareOfRate * std::max(rig.output.rate_Hz, 8000); }

Marker read_marker(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "marker", findings);
  Marker marker;
  marker.channel = reader.integer("channel", 0, kLastChannel);
  check_spare(reader, "channel", marker.channel, rig);
  const auto kind = reader.word("kind", {"pulse", "tone"});
  marker.kind = kind == "tone" ? Marker::Kind::tone : Marker::Kind::pulse;
  marker.amplitude = reader.number("amplitude", {0, 1, Range::Ends::open_low}, 0.5);
  marker.duration_s = 1e-3 * reader.number("duration_ms", {0, 1000, Range::Ends::open_low, "ms"}, 1);
  if (kind == "tone")
    marker.frequency_Hz = reader.number("frequency_Hz", {0, highest_Hz(rig), Range::Ends::open_low, "Hz"});
  reader.finish();
  return marker;
}

MaskingNoise read_noise(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "noise", findings);
  MaskingNoise noise;
  noise.channel = reader.integer("channel", 0, kLastChannel);
  check_spare(reader, "channel", noise.channel, rig);
  noise.rms = reader.number("rms", {0, 0.25, Range::Ends::open_low});
  if (const auto band = reader.maybe_interval("band_Hz", {0, highest_Hz(rig), Range::Ends::open_low, "Hz"}))
    noise.low_Hz = band->first, noise.high_Hz = band->second;
  else if (!reader.has("band_Hz"))
    reader.defaulted("band_Hz", "[100, 8000]");
  reader.finish();
  return noise;
}

void read_loop(TableReader& reader, const Rig& rig, Capture& capture) {
  capture.reference = reader.integer("reference", 0, 31);
  const auto& pick_ups = capture.pick_ups;
  if (capture.reference >= capture.channels)
    reader.problem("reference", "channel " + std::to_string(capture.reference) + " is not captured",
                   "a whole number from 0 to " + std::to_string(capture.channels - 1));
  else if (std::find(pick_ups.begin(), pick_ups.end(), capture.reference) != pick_ups.end())
    reader.problem("reference", "channel " + std::to_string(capture.reference) + " is also in \"pickups\"",
                   "use a channel of its own");
  capture.excitation_channel = reader.integer("excitation_channel", 0, kLastChannel);
  check_spare(reader, "excitation_channel", *capture.excitation_channel, rig);
}

Capture read_capture(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "capture", findings);
  Capture capture;
  capture.uri = read_uri(reader, {"sim:", "alsa:*"}, "\"sim:\" or \"alsa:NAME\"");
  capture.channels = reader.integer("channels", 1, 32);
  std::set<double> seen;
  for (const double channel : reader.numbers("pickups", {0, 31, Range::Ends::closed})) {
    if (channel != std::floor(channel) || channel >= capture.channels || !seen.insert(channel).second)
      reader.problem("pickups", "channel " + text::number(channel) + " is not a captured channel of its own",
                     "different whole numbers from 0 to " + std::to_string(capture.channels - 1));
    capture.pick_ups.push_back(static_cast<int>(channel));
  }
  if (capture.uri.starts_with("alsa:")) read_loop(reader, rig, capture);
  reader.finish();
  return capture;
}

}  // namespace

void read_spare_channels(TableReader& file, Rig& rig) {
  if (const auto* table = file.maybe_table("marker")) rig.marker = read_marker(*table, rig, file.findings());
  if (const auto* table = file.maybe_table("noise")) rig.noise = read_noise(*table, rig, file.findings());
  if (const auto* table = file.maybe_table("capture"))
    rig.capture = read_capture(*table, rig, file.findings());
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
