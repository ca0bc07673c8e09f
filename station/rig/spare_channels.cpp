#include "station/rig/spare_channels.hpp"

#include <algorithm>

#include "station/terms/limits.hpp"
#include "station/text/number.hpp"

namespace turnpoint::rig {

using text::Range;
using text::TableReader;

namespace {

void check_spare(TableReader& reader, int channel, const Rig& rig) {
  for (const auto& transducer : rig.transducers)
    if (transducer.channel == channel)
      reader.problem("channel", "channel " + std::to_string(channel) + " drives \"" + transducer.name + "\"",
                     "use a channel without a transducer");
}

double highest_Hz(const Rig& rig) { return terms::kHighestShareOfRate * std::max(rig.output.rate_Hz, 8000); }

Marker read_marker(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "marker", findings);
  Marker marker;
  marker.channel = reader.integer("channel", 0, kLastChannel);
  check_spare(reader, marker.channel, rig);
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
  check_spare(reader, noise.channel, rig);
  if (rig.marker && rig.marker->channel == noise.channel)
    reader.problem("channel", "channel " + std::to_string(noise.channel) + " is used by the marker",
                   "use a channel of its own");
  noise.rms = reader.number("rms", {0, 0.25, Range::Ends::open_low});
  if (const auto band = reader.maybe_interval("band_Hz", {0, highest_Hz(rig), Range::Ends::open_low, "Hz"}))
    noise.low_Hz = band->first, noise.high_Hz = band->second;
  else if (!reader.has("band_Hz"))
    reader.defaulted("band_Hz", "[100, 8000]");
  reader.finish();
  return noise;
}

}  // namespace

void read_spare_channels(TableReader& file, Rig& rig) {
  if (const auto* table = file.maybe_table("marker")) rig.marker = read_marker(*table, rig, file.findings());
  if (const auto* table = file.maybe_table("noise")) rig.noise = read_noise(*table, rig, file.findings());
}

int channels(const Rig& rig) {
  int last = 1;
  for (const auto& transducer : rig.transducers) last = std::max(last, transducer.channel);
  if (rig.marker) last = std::max(last, rig.marker->channel);
  if (rig.noise) last = std::max(last, rig.noise->channel);
  return last + 1;
}

}  // namespace turnpoint::rig
