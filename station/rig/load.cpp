#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "station/rig/csv.hpp"
#include "station/rig/rig.hpp"
#include "station/terms/limits.hpp"
#include "station/text/number.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::rig {

/// Reads the key "uri" of a table. `forms` are the allowed forms, such as "sim:" and "alsa:DEVICE". Text must
/// follow the scheme if the form has text after it.
std::string read_uri(text::TableReader& reader, const std::vector<std::string>& forms);

/// Checks a URI `gpio:name=LINE,name=LINE`; other schemes are accepted. It must contain all names in
/// `needed`, may contain those in `optional`, and must contain no others.
void check_gpio(text::TableReader& reader, const std::string& uri, const std::vector<std::string>& needed,
                const std::vector<std::string>& optional);

/// Reads [amplifier], [buttons], [contact], [trigger_lines] and [touch] of the file.
void read_devices(text::TableReader& file, Rig& rig);

/// The highest channel that a stream can have.
inline constexpr int kLastChannel = 7;

/// Reads [marker], [noise], [capture] and [sync], which use channels that drive no transducer. Call after the
/// transducers and the output have been read.
void read_spare_channels(text::TableReader& file, Rig& rig);

/// Reads the [surface] table with its [surface.taper].
Surface read_surface(const text::Value& table, text::Findings& findings);

using texts::phrase, texts::plain;

using text::TableReader;

std::string read_uri(TableReader& reader, const std::vector<std::string>& forms) {
  const auto allowed = text::quoted_list(forms);
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
                            phrase("each of %1 once, as name=LINE", {text::quoted_list(all)}));
  }
  for (const auto& name : needed)
    if (!seen.count(name))
      return reader.problem("uri", phrase("\"%1\" has no line \"%2\"", {plain(uri), plain(name)}),
                            phrase("needed: %1", {text::quoted_list(needed)}));
}

namespace {

std::optional<std::string> read_device(TableReader& file, const std::string& key,
                                       const std::vector<std::string>& forms,
                                       const std::vector<std::string>& lines,
                                       const std::vector<std::string>& optional_lines = {}) {
  const auto* table = file.maybe_table(key);
  if (!table) return std::nullopt;
  TableReader reader(*table, key, file.findings());
  const auto uri = read_uri(reader, forms);
  check_gpio(reader, uri, lines, optional_lines);
  reader.finish();
  return uri;
}

std::string read_thermometer(TableReader& reader, const std::string& key) {
  const auto allowed =
      phrase("%1 or %2, such as %3; NAME@DEVICE if several have that name",
             {plain("\"hwmon:NAME/tempN\""), plain("\"iio:NAME/temp\""), plain("\"hwmon:lm75/temp1\"")});
  const auto uri = reader.string(key, allowed);
  static const std::regex form("hwmon:[^/]+/temp[0-9]+|iio:[^/]+/temp[0-9a-z_]*");
  const bool good = std::regex_match(uri, form);
  if (!uri.empty() && !good)
    reader.problem(key, phrase("\"%1\" does not name a temperature sensor", {plain(uri)}),
                   phrase("allowed: %1", {allowed}));
  return uri;
}

std::optional<Thermometers> read_thermometers(TableReader& file) {
  const auto* table = file.maybe_table("temperature");
  if (!table) return std::nullopt;
  TableReader reader(*table, "temperature", file.findings());
  Thermometers made;
  made.plate_uri = read_thermometer(reader, "plate");
  made.frame_uri = read_thermometer(reader, "frame");
  reader.finish();
  return made;
}

}  // namespace

void read_devices(TableReader& file, Rig& rig) {
  if (!file.has("amplifier")) file.require("amplifier", phrase("add a table [amplifier] with uri"));
  rig.amplifier_uri =
      read_device(file, "amplifier", {"sim:", "gpio:enable=LINE,fault=LINE,stop=LINE,heartbeat=LINE"},
                  {"enable"}, {"fault", "stop", "heartbeat", "active", "fault_active", "stop_active"})
          .value_or("");
  rig.buttons_uri = read_device(file, "buttons", {"sim:", "gpio:left=LINE,right=LINE"}, {"left", "right"},
                                {"third", "active", "hold_ms", "refractory_ms"});
  rig.contact_uri = read_device(file, "contact", {"sim:", "gpio:line=LINE", "evdev:DEVICE"}, {"line"},
                                {"active", "hold_ms", "refractory_ms"});
  rig.trigger_lines_uri =
      read_device(file, "trigger_lines", {"sim:", "gpio:bit0=LINE,bit1=LINE,strobe=LINE"}, {"bit0"},
                  {"bit1", "bit2", "bit3", "bit4", "bit5", "bit6", "bit7", "strobe", "pulse_ms"});
  rig.touch_uri = read_device(file, "touch", {"sim:", "qt:", "evdev:DEVICE"}, {});
  rig.thermometers = read_thermometers(file);
}

using text::Range;

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

double highest_Hz(const Rig& rig) { return terms::kHighestShareOfRate * std::max(rig.output.rate_Hz, 8000); }

Marker read_marker(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "marker", findings);
  Marker marker;
  marker.channel = reader.integer("channel", 0, kLastChannel);
  check_spare(reader, "channel", marker.channel, rig);
  const auto kind = reader.word("kind", {"pulse", "tone", "code"});
  marker.kind = kind == "tone"   ? Marker::Kind::tone
                : kind == "code" ? Marker::Kind::code
                                 : Marker::Kind::pulse;
  // The code of an answer may be sent while an interval is played. It can then overlap the interval's code,
  // and the drive adds the amplitudes of both.
  const double most = kind == "code" ? 0.49 : 1;
  marker.amplitude =
      reader.number("amplitude", {0, most, Range::Ends::open_low}, kind == "code" ? 0.45 : 0.5);
  const Range length = kind == "code" ? Range{0.2, 20, Range::Ends::closed, "ms"}
                                      : Range{0, 1000, Range::Ends::open_low, "ms"};
  marker.duration_s = 1e-3 * reader.number("duration_ms", length, 1);
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
  if (const auto* signal = reader.maybe_table("signal")) {
    TableReader tone(*signal, "noise.signal", findings);
    noise.signal = MaskingNoise::Signal{};
    noise.signal->frequency_Hz =
        tone.number("frequency_Hz", {20, std::min(20e3, highest_Hz(rig)), Range::Ends::closed, "Hz"});
    noise.signal->amplitude = tone.number("amplitude", {0, 0.5, Range::Ends::open_low});
    tone.finish();
  }
  reader.finish();
  return noise;
}

void read_loop(TableReader& reader, const Rig& rig, Capture& capture) {
  capture.reference = reader.integer("reference", 0, 31);
  const auto& pick_ups = capture.pick_ups;
  if (capture.reference >= capture.channels)
    reader.problem("reference", phrase("channel %1 is not captured", {plain(capture.reference)}),
                   phrase("a whole number from 0 to %1", {plain(capture.channels - 1)}));
  else if (std::find(pick_ups.begin(), pick_ups.end(), capture.reference) != pick_ups.end())
    reader.problem("reference", phrase("channel %1 is also in \"pickups\"", {plain(capture.reference)}),
                   phrase("use a channel of its own"));
  capture.excitation_channel = reader.integer("excitation_channel", 0, kLastChannel);
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
  const auto channels = reader.numbers("bridges", {0, 31, Range::Ends::closed});
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
}

void read_marker_channel(TableReader& reader, const Rig& rig, Capture& capture) {
  if (!reader.has("marker_channel")) {
    reader.take("marker_channel");
    return;
  }
  capture.marker_channel = reader.integer("marker_channel", 0, 31);
  check_captured(reader, "marker_channel", *capture.marker_channel, capture);
  if (!rig.marker || rig.marker->kind != Marker::Kind::code)
    reader.problem("marker_channel", phrase("the rig has no marker with codes"),
                   phrase("add [marker] with %1, or leave this out", {plain("kind = \"code\"")}));
}

Sync read_sync(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "sync", findings);
  Sync sync;
  sync.uri = read_uri(reader, {"sim:", "gpio:line=LINE", "capture:"});
  check_gpio(reader, sync.uri, {"line"}, {"active"});
  if (sync.uri == "capture:") {
    sync.channel = reader.integer("channel", 0, 31);
    if (!rig.capture)
      reader.problem("uri", phrase("the rig captures nothing"),
                     phrase("add [capture], or use %1", {plain("\"gpio:line=LINE\"")}));
    else
      check_captured(reader, "channel", *sync.channel, *rig.capture);
  }
  reader.finish();
  return sync;
}

Capture read_capture(const text::Value& table, const Rig& rig, text::Findings& findings) {
  TableReader reader(table, "capture", findings);
  Capture capture;
  capture.uri = read_uri(reader, {"sim:", "alsa:NAME"});
  capture.channels = reader.integer("channels", 1, 32);
  std::set<double> seen;
  for (const double channel : reader.numbers("pickups", {0, 31, Range::Ends::closed})) {
    if (channel != std::floor(channel) || channel >= capture.channels || !seen.insert(channel).second)
      reader.problem(
          "pickups",
          phrase("channel %1 is not a captured channel of its own", {plain(text::number(channel))}),
          phrase("write different whole numbers from 0 to %1", {plain(capture.channels - 1)}));
    capture.pick_ups.push_back(static_cast<int>(channel));
  }
  const bool has_bridges = reader.has("bridges");
  if (has_bridges || capture.uri.starts_with("alsa:")) read_loop(reader, rig, capture);
  if (has_bridges)
    read_bridges(reader, capture);
  else
    reader.take("bridges");
  read_marker_channel(reader, rig, capture);
  reader.finish();
  return capture;
}

/// A name of the kernel, which may not contain what separates names in messages and files.
void check_name(TableReader& reader, const std::string& key, const std::string& name) {
  if (name.find_first_of(" \t/,\"") == std::string::npos) return;
  reader.problem(key, phrase("\"%1\" is not the name of a channel or trigger", {plain(name)}),
                 phrase("a name without spaces, slashes and commas, such as \"voltage0-voltage1\""));
}

CellConverter read_converter(const text::Value& table, Rig& rig, text::Findings& findings) {
  TableReader reader(table, "force_cells", findings);
  CellConverter converter;
  converter.uri = read_uri(reader, {"iio:DEVICE"});
  const std::array keys{"a", "b", "lateral"};
  for (std::size_t k = 0; k < keys.size(); ++k) {
    auto& name = converter.channels[k];
    name = reader.string(keys[k], phrase("the name of a channel, such as \"voltage0-voltage1\""));
    check_name(reader, keys[k], name);
    for (std::size_t other = 0; other < k; ++other)
      if (!name.empty() && converter.channels[other] == name)
        reader.problem(keys[k],
                       phrase("channel \"%1\" is also that of \"%2\"", {plain(name), plain(keys[other])}),
                       phrase("a channel of its own for each cell"));
  }
  // Below 80 samples a second the contact of a finger is not seen in time; the grid has 1000 points a second.
  converter.rate_Hz = reader.number("rate_Hz", {80, 1000, Range::Ends::closed, "Hz"});
  converter.sampling_frequency = reader.maybe_number("sampling_frequency", {0, 1e9, Range::Ends::open_low});
  converter.trigger = reader.maybe_string("trigger").value_or("");
  check_name(reader, "trigger", converter.trigger);
  converter.delay_s = 1e-3 * reader.number("delay_ms", {0, 1000, Range::Ends::closed, "ms"}, 0);
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
  if (const auto* table = file.maybe_table("marker")) rig.marker = read_marker(*table, rig, file.findings());
  if (const auto* table = file.maybe_table("noise")) rig.noise = read_noise(*table, rig, file.findings());
  if (const auto* table = file.maybe_table("capture"))
    rig.capture = read_capture(*table, rig, file.findings());
  if (const auto* table = file.maybe_table("force_cells")) {
    const auto converter = read_converter(*table, rig, file.findings());
    if (rig.capture) rig.capture->converter = converter;
  }
  if (const auto* table = file.maybe_table("sync")) rig.sync = read_sync(*table, rig, file.findings());
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

namespace {

using Ends = text::Range::Ends;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Handbook values for common tempers. A rig used for research should state its own values. The yield strength
// is only used to warn about a tension that the material cannot carry. expansion_per_K and modulus_per_K are
// the relative changes of length and of Young's modulus per kelvin at room temperature (for aluminium, from
// NIST's fits for 6061-T6). modulus_per_K is 0 where it depends on the product.
struct Material {
  const char* name;
  double density_kg_m3, modulus_GPa, poisson, yield_MPa, expansion_per_K, modulus_per_K;
};
constexpr std::array known_materials{
    Material{"aluminium", 2700, 69, 0.33, 275, 23.6e-6, -5.3e-4},
    Material{"brass", 8500, 105, 0.34, 450, 20e-6, -4e-4},
    Material{"copper", 8960, 120, 0.34, 210, 17e-6, -3.5e-4},
    Material{"glass", 2500, 70, 0.22, 45, 9e-6, 0},
    Material{"pmma", 1180, 3.1, 0.37, 70, 70e-6, 0},
    Material{"silicone rubber", 1100, 0.002, 0.49, 5, 300e-6, 0},
    Material{"steel", 7850, 205, 0.29, 350, 12e-6, -3e-4},
    Material{"titanium", 4430, 114, 0.34, 880, 8.6e-6, -5e-4},
};

const Material* find_material(const std::string& name) {
  for (const auto& material : known_materials)
    if (name == material.name) return &material;
  return nullptr;
}

void read_material(text::TableReader& reader, Surface& surface) {
  const auto word = reader.maybe_word("material", materials());
  surface.material = word.value_or("");
  const auto* filled = find_material(surface.material);
  const auto from_material = [&](const char* key, const Range& range, double fallback) {
    return filled ? reader.number(key, range, fallback) : reader.number(key, range);
  };
  surface.density_kg_m3 =
      from_material("density_kg_m3", {1, 30000, Ends::closed, "kg/m3"}, filled ? filled->density_kg_m3 : 0);
  surface.tension_Pa = reader.number("tension_Pa", {0, 1e12, Ends::closed, "Pa"});
  const std::vector<std::string> words{"auto", "on", "off"};
  const auto bending = reader.word("bending", words, "auto");
  surface.bending = bending == "on" ? Bending::on : bending == "off" ? Bending::off : Bending::automatic;
  if (surface.tension_Pa == 0 && surface.bending == Bending::off)
    reader.problem(
        "bending",
        phrase("\"bending\" is off although there is no tension, so nothing would hold the surface"),
        phrase("set \"tension_Pa\" above 0, or \"bending\" to \"auto\" or \"on\""));
  const bool needs_bending = surface.tension_Pa == 0 || surface.bending == Bending::on;
  const Range modulus{1e-6, 2000, Ends::closed, "GPa"}, poisson{-1, 0.5, Ends::open_low};
  if (filled || needs_bending || reader.has("modulus_GPa")) {
    surface.modulus_Pa = 1e9 * from_material("modulus_GPa", modulus, filled ? filled->modulus_GPa : 0);
    surface.poisson = from_material("poisson", poisson, filled ? filled->poisson : 0);
  } else {
    reader.take("modulus_GPa");
    surface.poisson = reader.maybe_number("poisson", poisson);
  }
  if (filled) surface.yield_Pa = 1e6 * filled->yield_MPa;
  if (const auto yield = reader.maybe_number("yield_MPa", {0, 1e5, Ends::open_low, "MPa"}))
    surface.yield_Pa = 1e6 * *yield;
}

double read_quality_factor(text::TableReader& reader) {
  const auto* value = reader.take("quality_factor");
  if (value && value->kind == text::Value::Kind::number && value->number == infinity) return infinity;
  return reader.number("quality_factor", {1, 1e9, Ends::closed, "(or inf: lossless)"});
}

void read_profile(const text::Value& list, text::TableReader& reader, Taper& taper) {
  const auto allowed = phrase(
      "write a list of %1 pairs in mm, with x in ascending order from 0 and half-widths above 0 that never "
      "increase",
      {plain("[x, half-width]")});
  const auto bad = [&](const text::Place& place, const texts::Phrase& what) {
    reader.findings().add(place, what, allowed);
  };
  if (list.kind != text::Value::Kind::array)
    return bad(list.place, phrase("\"%1\" is %2", {plain("profile_mm"), describe(list)}));
  for (const auto& item : list.items) {
    const bool pair = item.kind == text::Value::Kind::array && item.items.size() == 2;
    if (!pair) return bad(item.place, phrase("a point of \"profile_mm\" is not a pair"));
    for (const auto& x : item.items)
      if ((x.kind != text::Value::Kind::number && x.kind != text::Value::Kind::integer) ||
          !std::isfinite(x.number))
        return bad(x.place, phrase("a point of \"profile_mm\" contains %1", {describe(x)}));
    const double x_m = 1e-3 * item.items[0].number, w_m = 1e-3 * item.items[1].number;
    const auto& points = taper.profile_m;
    if (points.empty() ? x_m != 0 : x_m <= points.back().first)
      return bad(item.place, phrase("the x values of \"profile_mm\" are not in ascending order from 0"));
    if (w_m <= 0 || (!points.empty() && w_m > points.back().second))
      return bad(item.place,
                 phrase("a half-width of \"profile_mm\" is not above 0, or is larger than the one before"));
    taper.profile_m.emplace_back(x_m, w_m);
  }
  if (taper.profile_m.size() < 2) return bad(list.place, phrase("\"profile_mm\" has fewer than two points"));
  taper.half_width_m = taper.profile_m.front().second;
}

void check_length(const Surface& surface, text::TableReader& reader) {
  const auto& taper = surface.taper;
  if (taper.slope && taper.half_width_m - *taper.slope * surface.length_m < -1e-9)
    reader.problem("slope",
                   phrase("the half-width reaches 0 at %1 mm, before the end of the surface",
                          {plain(text::number(1e3 * taper.half_width_m / *taper.slope))}),
                   phrase("\"length_mm\" must be at most %1", {plain("half_width_mm / slope")}));
  if (!taper.profile_m.empty() && taper.profile_m.back().first < surface.length_m - 1e-9)
    reader.problem("profile_mm", phrase("the profile ends before the surface does"),
                   phrase("the last point must be at \"length_mm\" or beyond"));
}

void read_taper(const text::Value& table, Surface& surface, text::Findings& findings) {
  text::TableReader reader(table, "surface.taper", findings);
  auto& taper = surface.taper;
  const auto slope = reader.maybe_number("slope", {0, 1, Ends::open_low});
  const auto decay_mm = reader.maybe_number("decay_length_mm", {1, 1e6, Ends::closed, "mm"});
  const auto* profile = reader.take("profile_mm");
  const int forms = reader.has("slope") + reader.has("decay_length_mm") + reader.has("profile_mm");
  if (forms != 1)
    findings.add(reader.place(), phrase("[surface.taper] has %1 forms", {plain(forms)}),
                 phrase("give exactly one of \"slope\", \"decay_length_mm\" and \"profile_mm\""));
  const Range half_width{0.5, 1000, Ends::closed, "mm"};
  if (profile && reader.has("half_width_mm"))
    reader.problem(
        "half_width_mm",
        phrase("\"%1\" is not allowed together with \"%2\"", {plain("half_width_mm"), plain("profile_mm")}),
        phrase("leave it out: the profile already contains it"));
  if (!profile) taper.half_width_m = 1e-3 * reader.number("half_width_mm", half_width);
  reader.take("half_width_mm");
  taper.slope = slope;
  if (decay_mm) taper.decay_length_m = 1e-3 * *decay_mm;
  if (profile) read_profile(*profile, reader, taper);
  const Range sd_mm{0, 100, Ends::closed, "mm"};
  surface.half_width_sd_m = 1e-3 * reader.maybe_number("half_width_sd_mm", sd_mm).value_or(0);
  surface.slope_sd = reader.maybe_number("slope_sd", {0, 1}).value_or(0);
  surface.decay_length_sd_m =
      1e-3 * reader.maybe_number("decay_length_sd_mm", {0, 1e6, Ends::closed, "mm"}).value_or(0);
  surface.clamp_line_sd_m = 1e-3 * reader.maybe_number("clamp_line_sd_mm", sd_mm).value_or(0);
  if (surface.clamp_line_sd_m > 0 && taper.decay_length_m)
    reader.problem("clamp_line_sd_mm", phrase("an exponential taper has no clamp line"),
                   phrase("use \"half_width_sd_mm\""));
  check_length(surface, reader);
  reader.finish();
}

/// Reads standard deviations, and the changes of the surface with temperature.
void read_deviations(text::TableReader& reader, Surface& surface) {
  const auto number = [&](const char* key, const Range& range) {
    return reader.maybe_number(key, range).value_or(0);
  };
  surface.tension_sd_Pa = number("tension_sd_Pa", {0, 1e12, Ends::closed, "Pa"});
  surface.thickness_sd_m = 1e-3 * number("thickness_sd_mm", {0, 100, Ends::closed, "mm"});
  surface.density_sd_kg_m3 = number("density_sd_kg_m3", {0, 30000, Ends::closed, "kg/m3"});
  surface.modulus_sd_Pa = 1e9 * number("modulus_sd_GPa", {0, 2000, Ends::closed, "GPa"});
  surface.temperature_sd_K = number("temperature_sd_K", {0, 100, Ends::closed, "K"});
  const auto* filled = find_material(surface.material);
  const Range expansion{0, 1e-3, Ends::closed, "per K"}, softening{-0.02, 0.02, Ends::closed, "per K"};
  surface.expansion_per_K =
      reader.maybe_number("expansion_per_K", expansion).value_or(filled ? filled->expansion_per_K : 0);
  surface.modulus_per_K =
      reader.maybe_number("modulus_per_K", softening).value_or(filled ? filled->modulus_per_K : 0);
  if (surface.temperature_sd_K > 0 && surface.expansion_per_K == 0 && surface.modulus_per_K == 0)
    reader.problem("temperature_sd_K", phrase("nothing says how this surface changes with temperature"),
                   phrase("add \"expansion_per_K\" and \"modulus_per_K\""));
}

void read_plate_theory(text::TableReader& reader, Surface& surface) {
  const auto word = reader.word("plate_theory", {"kirchhoff", "mindlin", "elastic", "auto"}, "kirchhoff");
  surface.plate_theory = word == "mindlin"   ? PlateTheory::mindlin
                         : word == "elastic" ? PlateTheory::elastic
                         : word == "auto"    ? PlateTheory::automatic
                                             : PlateTheory::kirchhoff;
  const bool needed = word == "mindlin" || word == "elastic";
  const double poisson = surface.poisson.value_or(-1);
  if (needed && (surface.tension_Pa > 0 || surface.edges != Edges::clamped || poisson < 0 || poisson > 0.49))
    reader.problem("plate_theory", phrase("\"plate_theory\" is \"%1\" on this surface", {plain(word)}),
                   phrase("\"edges\" \"clamped\", \"tension_Pa\" 0 and \"poisson\" from 0 to 0.49 with it"));
}

}  // namespace

std::vector<std::string> materials() {
  std::vector<std::string> names;
  for (const auto& material : known_materials) names.emplace_back(material.name);
  return names;
}

Surface read_surface(const text::Value& table, text::Findings& findings) {
  text::TableReader reader(table, "surface", findings);
  Surface surface;
  read_material(reader, surface);
  surface.thickness_m = 1e-3 * reader.number("thickness_mm", {1e-3, 100, Ends::closed, "mm"});
  surface.length_m = 1e-3 * reader.number("length_mm", {1, 1e5, Ends::closed, "mm"});
  surface.quality_factor = read_quality_factor(reader);
  surface.edges = reader.word("edges", {"supported", "clamped"}, "supported") == "clamped" ? Edges::clamped
                                                                                           : Edges::supported;
  read_plate_theory(reader, surface);
  surface.wide_end =
      reader.word("wide_end", {"left", "right"}, "left") == "left" ? WideEnd::left : WideEnd::right;
  read_deviations(reader, surface);
  if (const auto* taper = reader.table("taper", phrase("add a table %1", {plain("[surface.taper]")})))
    read_taper(*taper, surface, findings);
  reader.finish();
  return surface;
}

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

using text::Findings;
using Ends = text::Range::Ends;
constexpr double pi = 3.14159265358979323846;

std::string beside(const std::string& path, const std::string& file) {
  const std::filesystem::path named(file);
  return named.is_absolute() ? file : (std::filesystem::path(path).parent_path() / named).string();
}

void read_response(TableReader& reader, const std::string& rig_path, Transducer& transducer) {
  const auto file = reader.maybe_string("response_csv");
  const auto um = reader.maybe_number("um_per_full_scale", {0, 1000, Ends::open_low, "um"});
  if (reader.has("response_csv") == reader.has("um_per_full_scale"))
    reader.findings().add(reader.place(), phrase("%1 needs exactly one response", {reader.title()}),
                          phrase("give either \"um_per_full_scale\" or \"response_csv\""));
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
                 {plain(csv), plain(text::number(row[0]))}),
          phrase("frequencies must be above 0 and in ascending order; um_per_full_scale must be above 0"));
    transducer.response.push_back({row[0], 1e-6 * row[1], row[2] * pi / 180});
  }
}

Transducer read_transducer(const text::Value& table, const std::string& rig_path, Findings& findings) {
  TableReader reader(table, titled("transducer", table), findings);
  Transducer transducer;
  transducer.name = reader.string("name", phrase("give the transducer a name, which messages use"));
  transducer.channel = reader.integer("channel", 0, kLastChannel);
  reader.require("band_kHz", phrase("give the usable band as %1 in kHz", {plain("[low, high]")}));
  if (const auto band = reader.maybe_interval("band_kHz", {0, 1000, Ends::open_low, "kHz"})) {
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
                          {plain(text::number(1e-3 * response.front().frequency_Hz)),
                           plain(text::number(1e-3 * response.back().frequency_Hz))}));
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
    rig.transducers.push_back(read_transducer(*table, rig.path, file.findings()));
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
  const auto* table = file.table("output", phrase("add a table [output] with uri and rate_Hz"));
  if (!table) return;
  TableReader reader(*table, "output", file.findings());
  auto& output = rig.output;
  output.uri = read_uri(reader, {"null:", "wav:FILE", "alsa:DEVICE"});
  output.rate_Hz = reader.integer("rate_Hz", 8000, 1536000);
  output.bits = reader.integer("bits", 16, 32, 24);
  output.period_frames = reader.integer("period_frames", 16, 65536, 384);
  output.periods = reader.integer("periods", 2, 64, 4);
  output.converter_delay_s = 1e-3 * reader.number("converter_delay_ms", {0, 100, Ends::closed, "ms"}, 0);
  if (reader.has("device_channels")) output.device_channels = reader.integer("device_channels", 1, 64);
  if (const double period_s = static_cast<double>(output.period_frames) / std::max(output.rate_Hz, 1);
      output.rate_Hz > 0 && period_s > longest_period_s)
    reader.problem(
        "period_frames",
        phrase("a period lasts %1 ms; the amplifier's guard would conclude that the audio thread has stopped",
               {plain(text::number(1e3 * period_s, 3))}),
        phrase("at most %1 ms: %2 frames",
               {plain(text::number(1e3 * longest_period_s)),
                plain(text::number(std::floor(longest_period_s * output.rate_Hz)))}));
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
  const double limit_Hz = terms::kHighestShareOfRate * rig.output.rate_Hz;
  for (const auto* table : file.tables("transducer")) {
    const auto* band = table->find("band_kHz");
    if (!band || band->value.items.size() != 2 || band->value.items[1].number * 1e3 <= limit_Hz) continue;
    file.findings().add(band->value.place,
                        phrase("the band ends at %1 kHz", {plain(text::number(band->value.items[1].number))}),
                        phrase("it may extend at most to 0.45 of rate_Hz, which is %1 kHz",
                               {plain(text::number(1e-3 * limit_Hz))}));
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
                 {plain(csv), plain(text::number(row[0]))}),
          phrase("displacements must be in ascending order from 0; friction must be 1 at displacement 0, at "
                 "least 0.001, never increase, and end below 1"));
    table.emplace_back(1e-6 * row[0], row[1]);
  }
  if (!table.empty() && falling(table).empty())
    reader.findings().add(place,
                          phrase("%1 has a row %2 um with a value that is not allowed",
                                 {plain(csv), plain(text::number(1e6 * table.back().first))}),
                          phrase("displacements must be in ascending order from 0; friction must be 1 at "
                                 "displacement 0, at least 0.001, never increase, and end below 1"));
  rig.friction.measured = true;
}

void read_friction(TableReader& file, Rig& rig) {
  static const text::Value empty;
  const auto* table = file.maybe_table("friction");
  rig.friction.stated = table != nullptr;
  TableReader reader(table ? *table : empty, "friction", file.findings());
  auto& friction = rig.friction;
  const Range pressure{0.01, 36, Ends::closed, "kPa"}, floor{0, 1, Ends::open_high};
  const Range fingertip{0.1, 100, Ends::closed, "mm"};
  const auto csv = reader.maybe_string("table_csv");
  if (reader.has("table_csv")) {
    for (const auto* key : {"model", "pressure_kPa", "floor"})
      if (reader.take(key))
        reader.problem(key,
                       phrase("\"%1\" is not allowed together with \"%2\"", {plain(key), plain("table_csv")}),
                       phrase("leave it out: the measured table replaces it"));
    if (csv) read_friction_table(reader, *csv, rig);
  } else {
    reader.word("model", {"load-sharing"}, "load-sharing");
    friction.pressure_Pa = 1e3 * reader.number("pressure_kPa", pressure, 5);
    friction.floor = reader.number("floor", floor, 0.1);
  }
  friction.fingertip_m = 1e-3 * reader.number("fingertip_mm", fingertip, 10);
  reader.finish();
}

void read_finger(TableReader& file, Rig& rig) {
  static const text::Value empty;
  const auto* table = file.maybe_table("finger");
  TableReader reader(table ? *table : empty, "finger", file.findings());
  const Range impedance{0, 1000, Ends::closed, "N s/m"}, phase{-90, 90, Ends::closed, "degrees"};
  constexpr double degree = pi / 180;
  auto& finger = rig.finger;
  finger.impedance_Ns_per_m = reader.number("impedance_Ns_per_m", impedance, 55);
  finger.impedance_sd_Ns_per_m = reader.number("impedance_sd_Ns_per_m", impedance, 15);
  finger.phase_rad = degree * reader.number("phase_deg", phase, 0);
  finger.phase_sd_rad = degree * reader.number("phase_sd_deg", {0, 90, Ends::closed, "degrees"}, 20);
  finger.contact_m = 1e-3 * reader.number("contact_mm", {1, 30, Ends::closed, "mm"}, 8);
  reader.finish();
}

void read_limits(TableReader& file, Rig& rig) {
  const auto* table = file.table("limits", phrase("add a table [limits] with displacement_um"));
  if (!table) return;
  TableReader reader(*table, "limits", file.findings());
  rig.limits.displacement_m = 1e-6 * reader.number("displacement_um", {0, 1000, Ends::open_low, "um"});
  rig.limits.continuous_s = reader.number("continuous_s", {0, 3600, Ends::open_low, "s"}, 30);
  rig.limits.duty = reader.number("duty", {0, 1, Ends::open_low}, 0.8);
  rig.limits.session_minutes = reader.number("session_minutes", {0, 1440, Ends::open_low, "minutes"}, 60);
  reader.finish();
}

}  // namespace

Rig parse(const std::string& source, const std::string& path) {
  const auto document = text::parse_toml(source, path);
  Findings findings;
  Rig rig;
  rig.path = path, rig.source = source, rig.sha256 = text::sha256(source);
  TableReader file(document, "", findings);
  file.word("format", {"friction-rig/1"});
  rig.name = file.string("name", phrase("give the rig a name that people recognise"));
  rig.reproduction = file.boolean("reproduction", "false");
  if (const auto* surface = file.table("surface", phrase("a table %1", {plain("[surface]")})))
    rig.surface = read_surface(*surface, findings);
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

Rig load(const std::string& path) { return parse(text::read_text_file(path), path); }

}  // namespace turnpoint::rig
