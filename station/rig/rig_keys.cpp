#include "station/rig/rig_keys.hpp"

#include "station/rig/rig.hpp"
#include "station/rig/surface.hpp"

namespace turnpoint::rig {

// The short names of this file are nobody else's.
namespace declarations {
namespace {

using core::Key;
using core::Keys;
using core::Range;
using namespace core::key;
using Ends = Range::Ends;

const Range sd_mm{0, 100, Ends::closed, "mm"};

Keys taper() {
  Keys keys{
      number("half_width_mm", {0.5, 1000, Ends::closed, "mm"}, "half of the width at the wide end")
          .required()
          .only_without("profile_mm"),
      number("slope", {0, 1, Ends::open_low},
             "a straight taper: by how much the half-width falls per length"),
      number("decay_length_mm", {1, 1e6, Ends::closed, "mm"},
             "an exponential taper: the length over which the half-width falls to 1/e"),
      list("profile_mm", {numbers("", {0, 1e6, Ends::closed, "mm"}, "").holding(2, 2)},
           "pairs [x, half-width], x ascending from 0, half-widths never increasing")
          .holding(2),
      number("half_width_sd_mm", sd_mm, "standard deviation of `half_width_mm`").by_default("0"),
      number("slope_sd", {0, 1}, "standard deviation of `slope`").by_default("0"),
      number("decay_length_sd_mm", {0, 1e6, Ends::closed, "mm"}, "standard deviation of `decay_length_mm`")
          .by_default("0"),
      number("clamp_line_sd_mm", sd_mm,
             "standard deviation of where the sides are really held: a fraction of the thickness behind the "
             "clamp's edge")
          .by_default("0"),
  };
  return keys.one_of({"slope", "decay_length_mm", "profile_mm"});
}

Keys surface() {
  return {
      word("material", materials(), "fills in what a handbook says about it").without_it("none"),
      number("density_kg_m3", {1, 30000, Ends::closed, "kg/m3"}, "density")
          .without_it("that of the material; required without one"),
      number("modulus_GPa", {1e-6, 2000, Ends::closed, "GPa"}, "Young's modulus")
          .without_it("that of the material; required without one if the surface bends"),
      number("poisson", {-1, 0.5, Ends::open_low}, "Poisson's ratio")
          .without_it("that of the material; required without one if the surface bends"),
      number("yield_MPa", {0, 1e5, Ends::open_low, "MPa"}, "yield strength; a higher tension is warned of")
          .without_it("that of the material"),
      number("tension_Pa", {0, 1e12, Ends::closed, "Pa"}, "tension of a membrane; 0 for a plate").required(),
      number("thickness_mm", {1e-3, 100, Ends::closed, "mm"}, "thickness").required(),
      number("length_mm", {1, 1e5, Ends::closed, "mm"}, "length, from the wide to the narrow end").required(),
      number("quality_factor", {1, 1e9, Ends::closed, "(or inf: lossless)"},
             "quality factor of the resonances")
          .or_infinite()
          .required(),
      word("edges", {"supported", "clamped"}, "how the sides are held").by_default("\"supported\""),
      word("bending", {"auto", "on", "off"}, "whether the stiffness to bending counts")
          .by_default("\"auto\""),
      word("plate_theory", {"kirchhoff", "mindlin", "elastic", "auto"}, "how a clamped plate is calculated")
          .by_default("\"auto\""),
      word("wide_end", {"left", "right"}, "where the wide end is, seen by the participant")
          .by_default("\"left\""),
      number("tension_sd_Pa", {0, 1e12, Ends::closed, "Pa"}, "standard deviation of `tension_Pa`")
          .by_default("0"),
      number("thickness_sd_mm", sd_mm, "standard deviation of `thickness_mm`").by_default("0"),
      number("density_sd_kg_m3", {0, 30000, Ends::closed, "kg/m3"}, "standard deviation of `density_kg_m3`")
          .by_default("0"),
      number("modulus_sd_GPa", {0, 2000, Ends::closed, "GPa"},
             "standard deviation of `modulus_GPa`, with the uncertainty of Poisson's ratio")
          .by_default("0"),
      number("quality_factor_sd", {0, 1e6},
             "standard deviation of `quality_factor`; in proportion, of a measured one too")
          .by_default("0"),
      number("temperature_sd_K", {0, 100, Ends::closed, "K"},
             "standard deviation of the temperature, around the one for which the other values hold")
          .by_default("0"),
      number("expansion_per_K", {0, 1e-3, Ends::closed, "per K"}, "relative change of length per kelvin")
          .without_it("that of the material"),
      number("modulus_per_K", {-0.02, 0.02, Ends::closed, "per K"},
             "relative change of Young's modulus per kelvin")
          .without_it("that of the material"),
      table("taper", taper(), "how the width falls along the surface").required(),
  };
}

Keys transducer() {
  Keys keys{
      string("name", "a name, which messages use").required(),
      integer("channel", 0, kLastChannel, "output channel").required(),
      interval("band_kHz", {0, 1000, Ends::open_low, "kHz"}, "the usable band").required(),
      number("um_per_full_scale", {0, 1000, Ends::open_low, "um"}, "displacement at full scale"),
      string("response_csv", "file with the columns frequency_Hz, um_per_full_scale and phase_deg"),
  };
  return keys.one_of({"um_per_full_scale", "response_csv"});
}

Keys output() {
  return {
      uri({"null:", "wav:FILE", "alsa:DEVICE"}, "where the samples go"),
      integer("rate_Hz", 8000, 1536000, "samples per second").required(),
      integer("bits", 16, 32, "bits of a sample").by_default("24"),
      integer("period_frames", 16, 65536, "frames of a period, which lasts at most 50 ms").by_default("384"),
      integer("periods", 2, 64, "periods in the device's buffer").by_default("4"),
      number("converter_delay_ms", {0, 100, Ends::closed, "ms"},
             "time that a sample takes from the device's buffer to the analog output")
          .by_default("0"),
      integer("device_channels", 1, 64, "channels of the device, if it has more than the rig uses")
          .without_it("as many as the rig uses"),
      strings("allow_plugin", "plug-ins of alsa-lib that tests may use").holding(0).by_default("[]"),
  };
}

Keys marker() {
  return {
      integer("channel", 0, kLastChannel, "an output channel of its own").required(),
      word("kind", {"pulse", "tone", "code"}, "what it plays at each event").required(),
      // The code of an answer may be sent while an interval is played. It can then overlap the interval's
      // code, and the drive adds the amplitudes of both.
      number("amplitude", {0, 0.49, Ends::open_low}, "fraction of full scale")
          .by_default("0.45")
          .only_with("kind", {"code"}),
      number("amplitude", {0, 1, Ends::open_low}, "fraction of full scale")
          .by_default("0.5")
          .only_with("kind", {"pulse", "tone"}),
      number("duration_ms", {0.2, 20, Ends::closed, "ms"}, "length of one bit")
          .by_default("1")
          .only_with("kind", {"code"}),
      number("duration_ms", {0, 1000, Ends::open_low, "ms"}, "length of the pulse or tone")
          .by_default("1")
          .only_with("kind", {"pulse", "tone"}),
      number("frequency_Hz", {0, 691200, Ends::open_low, "Hz"}, "at most 0.45 of the rate")
          .required()
          .only_with("kind", {"tone"}),
  };
}

Keys noise() {
  return {
      integer("channel", 0, kLastChannel, "an output channel of its own").required(),
      number("rms", {0, 0.25, Ends::open_low}, "fraction of full scale").required(),
      interval("band_Hz", {0, 691200, Ends::open_low, "Hz"}, "its band, at most to 0.45 of the rate")
          .by_default("[100, 8000]"),
      table("signal",
            {number("frequency_Hz", {20, 20e3, Ends::closed, "Hz"}, "at most 0.45 of the rate").required(),
             number("amplitude", {0, 0.5, Ends::open_low}, "fraction of full scale").required()},
            "the tone of response signals with `by = \"tone\"`")
          .without_it("no tone"),
  };
}

Keys capture() {
  return {
      uri({"sim:", "alsa:NAME"}, "what is captured"),
      integer("channels", 1, 32, "captured channels of the device").required(),
      integers("pickups", 0, 31, "captured channels of the pick-ups").required(),
      integer("reference", 0, 31, "captured channel to which `excitation_channel` is wired")
          .required()
          .only_with("uri", {"alsa:"})
          .only_with("bridges"),
      integer("excitation_channel", 0, kLastChannel, "an output channel that nothing else uses")
          .required()
          .only_with("uri", {"alsa:"})
          .only_with("bridges"),
      integers("bridges", 0, 31,
               "captured channels of the force cells: two below the surface, and the lateral one")
          .holding(3, 3),
      number("cells_resonance_Hz", {10, 1e5, Ends::closed, "Hz"},
             "lowest resonance of the plate on its cells, for scenes that follow the finger")
          .without_it("as the calibration measured it")
          .only_with("bridges"),
      number("cells_damping", {0, 1, Ends::open_high}, "damping ratio of this resonance")
          .by_default("0.05")
          .only_with("cells_resonance_Hz"),
      integer("marker_channel", 0, 31, "captured channel to which a marker with codes is wired"),
  };
}

Keys force_cells() {
  const auto name = [](const char* key, const char* help) {
    return string(key, help).matching(
        "^[^ \\t/,\"]+$", "a name without spaces, slashes and commas, such as \"voltage0-voltage1\"");
  };
  return {
      uri({"iio:DEVICE"}, "name or label of the converter"),
      name("a", "channel of the normal cell near the wide edge, such as \"voltage0-voltage1\"").required(),
      name("b", "channel of the other normal cell").required(),
      name("lateral", "channel of the lateral cell").required(),
      // Below 80 samples a second the contact of a finger is not seen in time; the grid has 1000 points a
      // second.
      number("rate_Hz", {80, 1000, Ends::closed, "Hz"}, "samples of each channel per second").required(),
      number("sampling_frequency", {0, 1e9, Ends::open_low}, "the driver's setting, in its own unit")
          .without_it("as the driver has it"),
      name("trigger", "for boards whose driver has no trigger of its own").without_it("the driver's own"),
      number("delay_ms", {0, 1000, Ends::closed, "ms"}, "by how much the converter's filter delays a sample")
          .by_default("0"),
  };
}

Key thermometer(const char* name, const char* help) {
  return string(name, help)
      .matching("^(hwmon:[^/]+/temp[0-9]+|iio:[^/]+/temp[0-9a-z_]*)$",
                "\"hwmon:NAME/tempN\" or \"iio:NAME/temp\", such as \"hwmon:lm75/temp1\"; NAME@DEVICE if "
                "several have that name")
      .required();
}

const Keys& all() {
  const Range impedance{0, 1000, Ends::closed, "N s/m"};
  static const Keys keys{
      word("format", {"friction-rig/1"}, "the version of this format").required(),
      string("name", "a name that people recognise").required(),
      boolean("reproduction", "reproduces figures of a paper; never for a finger"),
      table("surface", surface(), "the membrane or plate").required(),
      tables("transducer", transducer(), "one table for each drive element").required(),
      table("output", output(), "the converter that drives the surface").required(),
      table("amplifier", {uri({"sim:", "gpio:enable=LINE,fault=LINE,stop=LINE,heartbeat=LINE"}, "its lines")},
            "the amplifier's lines")
          .required(),
      table("buttons", {uri({"sim:", "gpio:left=LINE,right=LINE"}, "their lines")}, "answer buttons"),
      table("contact", {uri({"sim:", "gpio:line=LINE", "evdev:DEVICE"}, "its line or device")},
            "the touch sensor of the surface"),
      table("touch", {uri({"sim:", "qt:", "evdev:DEVICE"}, "the touchscreen")}, "the participant's screen"),
      table("marker", marker(), "a signal at each onset and change, for a recorder"),
      table("noise", noise(), "headphones of the participant"),
      table("capture", capture(), "pick-ups, and captured force cells"),
      table("force_cells", force_cells(), "force cells on a converter with a clock of its own"),
      table("temperature",
            {thermometer("plate", "thermometer of the plate, such as \"hwmon:lm75/temp1\""),
             thermometer("frame", "thermometer of its frame")},
            "thermometers"),
      table("trigger_lines", {uri({"sim:", "gpio:bit0=LINE,bit1=LINE,strobe=LINE"}, "their lines")},
            "trigger codes on lines"),
      table("sync",
            {uri({"sim:", "gpio:line=LINE", "capture:"}, "where pulses of another device arrive"),
             integer("channel", 0, 31, "captured channel").required().only_with("uri", {"capture:"})},
            "pulses of another device"),
      table("friction",
            {string("table_csv",
                    "measured friction: file with the columns displacement_um and relative_friction"),
             word("model", {"load-sharing"}, "model of the friction")
                 .by_default("\"load-sharing\"")
                 .only_without("table_csv"),
             number("pressure_kPa", {0.01, 36, Ends::closed, "kPa"}, "pressure under the finger")
                 .by_default("5")
                 .only_without("table_csv"),
             number("floor", {0, 1, Ends::open_high}, "relative friction that always remains")
                 .by_default("0.1")
                 .only_without("table_csv"),
             number("fingertip_mm", {0.1, 100, Ends::closed, "mm"}, "length over which a finger averages")
                 .by_default("10")},
            "how displacement lowers friction"),
      table("finger",
            {number("impedance_Ns_per_m", impedance, "force divided by velocity at ultrasonic frequencies")
                 .by_default("55"),
             number("impedance_sd_Ns_per_m", impedance, "its standard deviation between people")
                 .by_default("15"),
             number("phase_deg", {-90, 90, Ends::closed, "degrees"},
                    "0: viscous; above 0: like a mass; below 0: like a spring")
                 .by_default("0"),
             number("phase_sd_deg", {0, 90, Ends::closed, "degrees"}, "standard deviation of `phase_deg`")
                 .by_default("20"),
             number("contact_mm", {1, 30, Ends::closed, "mm"}, "diameter of the contact").by_default("8"),
             number("skin_mm_per_N", {0, 10, Ends::closed, "mm/N"},
                    "how far a lateral force stretches the skin, for scenes that follow the finger")
                 .by_default("1")},
            "the mechanical impedance of a finger"),
      table("limits",
            {number("displacement_um", {0, 1000, Ends::open_low, "um"}, "largest displacement").required(),
             number("continuous_s", {0, 3600, Ends::open_low, "s"}, "longest time without a pause")
                 .by_default("30"),
             number("duty", {0, 1, Ends::open_low}, "largest share of the time with vibration")
                 .by_default("0.8"),
             number("session_minutes", {0, 1440, Ends::open_low, "minutes"}, "longest session")
                 .by_default("60")},
            "what the finger may be exposed to")
          .required(),
  };
  return keys;
}

}  // namespace
}  // namespace declarations

const core::Keys& rig_keys() { return declarations::all(); }

}  // namespace turnpoint::rig
