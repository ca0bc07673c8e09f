#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "station/rig/rig.hpp"
#include "station/system/read_file.hpp"
#include "station/text/toml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

const std::string simulated = std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated.toml";

// Returns a rig file into which the tests put mistakes.
std::string source() {
  return system::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
}

std::string replaced(std::string where, const std::string& from, const std::string& to) {
  const auto at = where.find(from);
  REQUIRE(at != std::string::npos);
  return where.replace(at, from.size(), to);
}

// Replaces `from` by `to` in the rig file, and returns the problems that are reported, one per line.
std::string problems(const std::string& from, const std::string& to) {
  try {
    rig::parse(replaced(source(), from, to), "r.toml");
    return "";
  } catch (const text::BadInput& error) {
    return error.what();
  }
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the simulated rig loads in SI units", "[rig]") {
  const auto rig = rig::load(simulated);
  CHECK(rig.name == "Aluminium tapered plate, simulated");
  CHECK(rig.surface.thickness_m == Approx(3e-3));
  CHECK(rig.surface.modulus_Pa.value() == Approx(69e9));
  CHECK(rig.surface.yield_Pa.value() > 1e8);
  CHECK(rig.surface.edges == rig::Edges::clamped);
  CHECK(rig.surface.plate_theory == rig::PlateTheory::mindlin);
  CHECK(rig.surface.taper.half_width_m == Approx(15.1e-3));
  CHECK(rig.surface.taper.slope.value() == Approx(0.03));
  REQUIRE(rig.transducers.size() == 1);
  CHECK(rig.transducers[0].high_Hz == Approx(60e3));
  CHECK(rig.transducers[0].m_per_full_scale.value() == Approx(4e-6));
  CHECK(rig.output.uri == "null:");
  CHECK(rig.buttons_uri.value() == "sim:");
  CHECK_FALSE(rig.friction.measured);
  CHECK(rig.friction.fingertip_m == Approx(0.01));
  CHECK(rig.limits.displacement_m == Approx(8e-6));
  CHECK(rig.sha256 == rig::parse(system::read_file(simulated), "elsewhere").sha256);
}

TEST_CASE("a rig states the finger that loads its surface, in N s/m, degrees and mm", "[rig]") {
  const auto text = replaced(replaced(source(), "impedance_Ns_per_m = 55", "impedance_Ns_per_m = 40"),
                             "phase_deg = 0", "phase_deg = 30");
  const auto rig = rig::parse(text, "rig.toml");
  CHECK(rig.finger.impedance_Ns_per_m == 40);
  CHECK(rig.finger.impedance_sd_Ns_per_m == 15);
  CHECK(rig.finger.phase_rad == Approx(M_PI / 6));
  CHECK(rig.finger.phase_sd_rad == Approx(M_PI / 9));
  CHECK(rig.finger.contact_m == Approx(8e-3));
  const auto at = source().find("[finger]");
  const auto without =
      rig::parse(source().substr(0, at) + source().substr(source().find("[limits]")), "rig.toml");
  CHECK(without.finger.impedance_Ns_per_m == 55);
  const auto& used = without.defaults_used;
  CHECK(std::find(used.begin(), used.end(), "finger.impedance_Ns_per_m = 55") != used.end());
  CHECK(contains(problems("contact_mm = 8", "contact_mm = 0"), "\"contact_mm\" is 0"));
}

TEST_CASE("every shipped plate states what is not known about its surface", "[rig]") {
  for (const char* name : {"simulated", "raspberry-pi-aluminium", "pc-usb"}) {
    CAPTURE(name);
    const auto& surface =
        rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/" + name + ".toml").surface;
    CHECK(surface.thickness_sd_m == Approx(0.055e-3));
    CHECK(surface.modulus_sd_Pa == Approx(1e9));
    CHECK(surface.density_sd_kg_m3 > 0);
    CHECK(surface.half_width_sd_m > 0);
    CHECK(surface.slope_sd > 0);
    CHECK(surface.clamp_line_sd_m == Approx(0.3e-3));
    CHECK(surface.temperature_sd_K == 3);
    CHECK(surface.expansion_per_K == Approx(23.6e-6));
    CHECK(surface.modulus_per_K == Approx(-5.3e-4));
  }
}

TEST_CASE("a rig's deviations are in range, and temperature needs what it changes", "[rig]") {
  CHECK(contains(problems("clamp_line_sd_mm = 0.2", "clamp_line_sd_mm = -0.2"),
                 "\"clamp_line_sd_mm\" is -0.2"));
  CHECK(contains(problems("temperature_sd_K = 3", "temperature_sd_K = 300"), "\"temperature_sd_K\" is 300"));
  CHECK(problems("temperature_sd_K = 3", "temperature_sd_K = 3\nmodulus_per_K = -1e-3").empty());
  CHECK(contains(problems("material = \"aluminium\"\n", ""), "how this surface changes with temperature"));
}

TEST_CASE("every default that was used for a missing key is named with its value", "[rig]") {
  const auto used = rig::load(simulated).defaults_used;
  const auto has = [&](const char* line) { return std::find(used.begin(), used.end(), line) != used.end(); };
  CHECK(has("reproduction = false"));
  CHECK(has("surface.bending = \"auto\""));
  CHECK(has("output.bits = 24"));
  CHECK(has("output.period_frames = 384"));
  CHECK(has("output.converter_delay_ms = 0"));
  CHECK_FALSE(has("limits.duty = 0.8"));  // the file sets this value, so it is not a default
}

TEST_CASE("the converter's delay is read in ms, and a negative one is refused", "[rig]") {
  const auto with = [](const char* line) {
    return rig::parse(replaced(source(), "rate_Hz = 192000", std::string("rate_Hz = 192000\n") + line),
                      "r.toml");
  };
  CHECK(with("converter_delay_ms = 0.104").output.converter_delay_s == Approx(0.104e-3));
  CHECK_THROWS_AS(with("converter_delay_ms = -0.1"), text::BadInput);
  CHECK_THROWS_AS(with("converter_delay_ms = \"0.1\""), text::BadInput);
}

TEST_CASE("all mistakes in a rig file are reported at once, each with its line", "[rig]") {
  auto bad = replaced(source(), "thickness_mm = 2.0", "thicknes_mm = 2.0");
  bad = replaced(bad, "slope = 0.03", "slope = -0.03");
  bad = replaced(bad, "channel = 0", "channel = \"0\"");
  try {
    rig::parse(bad, "r.toml");
    FAIL("the file has three mistakes");
  } catch (const text::BadInput& error) {
    const std::string all = error.what();
    // the misspelt key causes two problems: it is unknown, and the right key is missing
    CHECK(error.problems().size() == 4);
    CHECK(contains(all,
                   "r.toml:12:1: unknown key \"thicknes_mm\" in [surface]; did you mean \"thickness_mm\"?"));
    CHECK(contains(all, "[surface] needs the key \"thickness_mm\""));
    CHECK(contains(all, "r.toml:26:9: \"slope\" is -0.03; allowed: above 0 and at most 1"));
    CHECK(contains(all, "r.toml:35:11: \"channel\" is the text \"0\"; a whole number from 0 to 7 is needed"));
  }
}

TEST_CASE("invalid values in a rig file are refused, with what is allowed", "[rig]") {
  CHECK(contains(problems("rate_Hz = 192000", "rate_Hz = 96000"),
                 "it may extend at most to 0.45 of rate_Hz, which is 43.2 kHz"));
  CHECK(contains(problems("\"null:\"", "\"pulse:\""), "allowed: \"null:\", \"wav:FILE\" or \"alsa:DEVICE\""));
  CHECK(contains(problems("length_mm = 300", "length_mm = 500"), "before the end of the surface"));
  CHECK(contains(problems("slope = 0.03", "slope = 0.03\ndecay_length_mm = 300"), "has 2 forms"));
  CHECK(contains(problems("slope = 0.03", ""), "has 0 forms"));
  CHECK(contains(problems("quality_factor = 60", "quality_factor = nan"), "\"quality_factor\" is nan"));
  CHECK(contains(problems("\"aluminium\"", "\"aluminum\""), "did you mean \"aluminium\"?"));
  CHECK(contains(problems("band_kHz = [14, 60]", "band_kHz = [60, 14]"), "the smaller first"));
  CHECK(contains(problems("tension_Pa = 0 ", "tension_Pa = inf "), "\"tension_Pa\" is inf"));
  CHECK(contains(problems("model = \"load-sharing\"", "table_csv = \"none.csv\""), "cannot read"));
  CHECK(contains(problems("friction-rig/1", "friction-rig/2"), "allowed: \"friction-rig/1\""));
  CHECK(contains(problems("[amplifier]\nuri = \"sim:\"", "[amplifier]\nuri = \"gpio:fault=A\""),
                 "no line \"enable\""));
  CHECK(contains(problems("[surface]", "[surface"), "not valid TOML"));
  CHECK(problems("quality_factor = 60", "quality_factor = inf").empty());
  const std::string thick = "quality_factor = 60\nplate_theory = \"mindlin\"";
  CHECK(problems("quality_factor = 60", thick).empty());
  CHECK(contains(problems("tension_Pa = 0 ", "plate_theory = \"elastic\"\ntension_Pa = 1e8 "),
                 "\"plate_theory\" is \"elastic\" on this surface"));
  CHECK(
      contains(problems("quality_factor = 60", "quality_factor = 60\nplate_theory = \"thick\""), "mindlin"));
}

TEST_CASE("spare channels carry a marker and masking noise", "[rig]") {
  const std::string both =
      "[marker]\nchannel = 1\nkind = \"tone\"\nfrequency_Hz = 5000\nduration_ms = 2\n"
      "[noise]\nchannel = 3\nrms = 0.05\nsignal = { frequency_Hz = 1000, amplitude = 0.2 }\n\n[limits]";
  const auto rig = rig::parse(replaced(source(), "[limits]", both), "r.toml");
  REQUIRE(rig.marker);
  CHECK(rig.marker->kind == rig::Marker::Kind::tone);
  CHECK(rig.marker->duration_s == Approx(2e-3));
  REQUIRE(rig.noise);
  CHECK(rig.noise->high_Hz == 8000);
  REQUIRE(rig.noise->signal);
  CHECK(rig.noise->signal->frequency_Hz == 1000);
  CHECK(rig.noise->signal->amplitude == 0.2);
  CHECK(rig::channels(rig) == 4);
  CHECK(rig::channels(rig::load(simulated)) == 2);
}

TEST_CASE("a rig names the captured channels of its pick-ups", "[rig]") {
  const auto with = [](const std::string& keys) {
    return problems("[limits]", "[capture]\n" + keys + "\n[limits]");
  };
  const auto rig = rig::parse(
      replaced(source(), "[limits]", "[capture]\nuri = \"sim:\"\nchannels = 4\npickups = [3, 1]\n[limits]"),
      "r.toml");
  REQUIRE(rig.capture);
  CHECK(rig.capture->channels == 4);
  CHECK(rig.capture->pick_ups == std::vector<int>{3, 1});
  CHECK_FALSE(rig::load(simulated).capture);
  CHECK(
      contains(with("uri = \"sim:\"\nchannels = 2\npickups = [2]"),
               "channel 2 is not a captured channel of its own; write different whole numbers from 0 to 1"));
  CHECK(contains(with("uri = \"sim:\"\nchannels = 2\npickups = [1, 1]"), "channel 1"));
  CHECK(contains(with("uri = \"sim:\"\nchannels = 2\npickups = [0.5]"), "channel 0.5"));
  CHECK(contains(with("uri = \"usb:\"\nchannels = 2\npickups = [0]"), "allowed: \"sim:\" or \"alsa:NAME\""));
  CHECK(contains(with("uri = \"sim:\"\nchannels = 2"), "\"pickups\""));
}

TEST_CASE("a capture on a card needs a loop: an output channel of its own, wired to a captured one",
          "[rig]") {
  const std::string card = "[capture]\nuri = \"alsa:hw:1\"\nchannels = 4\npickups = [1, 2]\n";
  const auto with = [&](const std::string& keys) {
    return problems("[limits]", "[marker]\nchannel = 1\nkind = \"pulse\"\n" + card + keys + "\n[limits]");
  };
  const auto rig = rig::parse(
      replaced(source(), "[limits]", card + "reference = 3\nexcitation_channel = 4\n[limits]"), "r.toml");
  REQUIRE(rig.capture);
  CHECK(rig.capture->uri == "alsa:hw:1");
  CHECK(rig.capture->reference == 3);
  CHECK(rig.capture->excitation_channel == 4);
  CHECK(rig::channels(rig) == 5);
  const auto cells =
      rig::parse(replaced(source(), "[limits]",
                          "[capture]\nuri = \"alsa:hw:1\"\nchannels = 6\npickups = [1, 2]\nreference = 0\n"
                          "excitation_channel = 4\nbridges = [3, 4, 5]\n[limits]"),
                 "r.toml");
  CHECK(cells.capture.value().bridges == std::vector<int>{3, 4, 5});
  CHECK(contains(with(""), "\"reference\""));
  CHECK(contains(with(""), "\"excitation_channel\""));
  CHECK(contains(with("reference = 4\nexcitation_channel = 2"),
                 "channel 4 is not captured; a whole number from 0 to 3"));
  CHECK(contains(with("reference = 1\nexcitation_channel = 2"), "channel 1 is also in \"pickups\""));
  CHECK(contains(with("reference = 0\nexcitation_channel = 0"), "channel 0 drives"));
  CHECK(contains(with("reference = 0\nexcitation_channel = 1"), "channel 1 is used by the marker"));
  CHECK(contains(with("reference = 0\nexcitation_channel = 9"), "0 to 7"));
  CHECK(contains(problems("[limits]",
                          "[capture]\nuri = \"sim:\"\nchannels = 2\npickups = [0]\n"
                          "reference = 1\n[limits]"),
                 "\"reference\""));
}

TEST_CASE("force cells may be on a converter with a clock of its own, beside a capture on the card",
          "[rig]") {
  const std::string card =
      "[capture]\nuri = \"alsa:hw:1\"\nchannels = 4\npickups = [1, 2]\nreference = 0\nexcitation_channel = "
      "4\n";
  const std::string
      head = "[force_cells]\nuri = \"iio:ad7124-4\"\n",
      cells = "a = \"voltage0-voltage1\"\nb = \"voltage2-voltage3\"\nlateral = \"voltage4-voltage5\"\n";
  const auto rig = rig::parse(
      replaced(source(), "[limits]",
               card + head + cells + "rate_Hz = 500\nsampling_frequency = 9600\ndelay_ms = 3\n[limits]"),
      "r.toml");
  REQUIRE(rig.capture.value().converter);
  const auto& converter = *rig.capture->converter;
  CHECK(converter.uri == "iio:ad7124-4");
  CHECK(converter.channels ==
        std::array<std::string, 3>{"voltage0-voltage1", "voltage2-voltage3", "voltage4-voltage5"});
  CHECK(converter.rate_Hz == 500);
  CHECK(converter.sampling_frequency.value() == 9600);
  CHECK(converter.trigger.empty());
  CHECK(converter.delay_s == Approx(0.003));
  CHECK(rig::has_force_cells(rig));
  const auto with = [&](const std::string& text) { return problems("[limits]", text + "\n[limits]"); };
  const auto rate = std::string("rate_Hz = 500\n");
  CHECK(with(card + head + cells + rate).empty());
  CHECK(contains(with(head + cells + rate), "add [capture] with uri = \"alsa:NAME\""));
  CHECK(contains(with("[capture]\nuri = \"sim:\"\nchannels = 2\npickups = [0]\n" + head + cells + rate),
                 "add [capture] with uri = \"alsa:NAME\""));
  CHECK(contains(with("[capture]\nuri = \"alsa:hw:1\"\nchannels = 6\npickups = [1, 2]\nreference = 0\n"
                      "excitation_channel = 4\nbridges = [3, 4, 5]\n" +
                      head + cells + rate),
                 "leave out \"bridges\" or [force_cells]"));
  CHECK(contains(with(card + "[force_cells]\nuri = \"gpio:line=X\"\n" + cells + rate), "\"iio:DEVICE\""));
  CHECK(contains(with(card + head + rate), "\"lateral\""));
  CHECK(contains(with(card + head + cells), "\"rate_Hz\""));
  CHECK(contains(with(card + head + cells + "rate_Hz = 4800\n"), "80"));
  CHECK(contains(with(card + head + cells + rate + "trigger = \"a b\"\n"), "\"a b\" is not the name"));
  CHECK(contains(with(card + head + "a = \"x\"\nb = \"x\"\nlateral = \"z\"\n" + rate),
                 "channel \"x\" is also that of \"a\""));
}

TEST_CASE("a rig gives out trigger codes on the marker channel and on lines, and takes pulses", "[rig]") {
  const std::string marker = "[marker]\nchannel = 1\nkind = \"code\"\n",
                    capture = "[capture]\nuri = \"sim:\"\nchannels = 4\npickups = [0]\n",
                    lines = "[trigger_lines]\nuri = \"gpio:bit0=A,bit1=B,bit2=C,strobe=D,pulse_ms=2\"\n",
                    sync = "[sync]\nuri = \"capture:\"\nchannel = 3\n";
  const auto parsed = [](const std::string& more) {
    return rig::parse(replaced(source(), "[limits]", more + "[limits]"), "r.toml");
  };
  const auto with = [](const std::string& more) { return problems("[limits]", more + "\n[limits]"); };
  const auto rig = parsed(marker + capture + "marker_channel = 2\n" + lines + sync);
  CHECK(rig.marker->kind == rig::Marker::Kind::code);
  CHECK(rig.marker->duration_s == Approx(1e-3));
  CHECK(rig.capture->marker_channel == 2);
  CHECK(rig.sync->channel == 3);
  CHECK(rig::largest_trigger_code(rig) == 7);
  CHECK(rig::largest_trigger_code(parsed(marker)) == 255);
  CHECK(rig::largest_trigger_code(parsed("[trigger_lines]\nuri = \"sim:\"\n")) == 255);
  CHECK(rig::largest_trigger_code(rig::load(simulated)) == 0);
  CHECK(contains(with(marker + "duration_ms = 30"), "from 0.2 to 20 ms"));
  CHECK(contains(with(marker + "amplitude = 0.5"), "0.49"));
  CHECK(contains(with(capture + "marker_channel = 2"), "the rig has no marker with codes"));
  CHECK(contains(with(marker + capture + "marker_channel = 0"),
                 "channel 0 is also captured for something else"));
  CHECK(contains(with(marker + capture + "marker_channel = 4"), "channel 4 is not captured"));
  CHECK(contains(with(sync), "the rig captures nothing"));
  CHECK(contains(with("[sync]\nuri = \"gpio:in=A\"\n"), "does not name a line"));
  CHECK(contains(with("[trigger_lines]\nuri = \"gpio:bit1=A\"\n"), "has no line \"bit0\""));
}

TEST_CASE("a thermometer is of one of two subsystems of the kernel", "[rig]") {
  const auto with = [](const std::string& plate) {
    return problems("[limits]", "[temperature]\nplate = \"" + plate +
                                    "\"\nframe = \"hwmon:lm75@1-0049/temp1\"\n[limits]");
  };
  for (const char* good :
       {"hwmon:lm75/temp1", "iio:tmp117/temp", "iio:tmp117@1-0048/temp", "iio:mlx90614/temp_object"})
    CHECK(with(good).empty());
  for (const char* bad :
       {"hwmon:lm75/temp", "hwmon:lm75", "iio:tmp117", "iio:tmp117/in_temp", "iio:/temp", "lm75/temp1"})
    CHECK(contains(with(bad), "does not name a temperature sensor"));
}

TEST_CASE("a device may have more channels than the rig uses, not fewer", "[rig]") {
  CHECK(rig::parse(source(), "r.toml").output.device_channels == 0);
  CHECK(rig::parse(replaced(source(), "rate_Hz = 192000", "rate_Hz = 192000\ndevice_channels = 10"), "r.toml")
            .output.device_channels == 10);
  CHECK(contains(problems("rate_Hz = 192000", "rate_Hz = 192000\ndevice_channels = 1"),
                 "device_channels is 1; at least 2, the number of channels that the rig uses"));
  CHECK(contains(problems("rate_Hz = 192000", "rate_Hz = 192000\ndevice_channels = 65"), "1 to 64"));
}

TEST_CASE("a spare channel is one that nothing else drives", "[rig]") {
  const auto taken = problems(
      "[limits]", "[marker]\nchannel = 0\nkind = \"pulse\"\n[noise]\nchannel = 0\nrms = 0.5\n[limits]");
  CHECK(contains(taken, "channel 0 drives"));
  CHECK(contains(taken, "use a channel without a transducer"));
  CHECK(contains(taken, "channel 0 is used by the marker"));
  CHECK(contains(taken, "\"rms\""));
  CHECK(contains(problems("[limits]", "[marker]\nchannel = 8\nkind = \"click\"\n[limits]"), "\"click\""));
}

TEST_CASE("a material provides the constants that the file does not state", "[rig]") {
  const auto lines = "density_kg_m3 = 2700\nmodulus_GPa = 69\npoisson = 0.33\n";
  const auto rig = rig::parse(replaced(source(), lines, ""), "r.toml");
  CHECK(rig.surface.density_kg_m3 == 2700);
  CHECK(rig.surface.modulus_Pa.value() == Approx(69e9));
  const auto& used = rig.defaults_used;
  CHECK(std::find(used.begin(), used.end(), "surface.density_kg_m3 = 2700") != used.end());
  CHECK(contains(problems(std::string("material = \"aluminium\"\n") + lines, ""),
                 "needs the key \"density_kg_m3\""));
}

TEST_CASE("a plate needs its modulus, a tensioned membrane may leave it out", "[rig]") {
  auto without = replaced(replaced(source(), "material = \"aluminium\"\n", ""),
                          "modulus_GPa = 69\npoisson = 0.33\n", "");
  without = replaced(without, "temperature_sd_K = 3\n", "");
  CHECK_THROWS_AS(rig::parse(without, "r.toml"), text::BadInput);
  const auto membrane = rig::parse(replaced(without, "tension_Pa = 0 ", "tension_Pa = 1e8 "), "r.toml");
  CHECK_FALSE(membrane.surface.modulus_Pa.has_value());
}

TEST_CASE("a period that the amplifier's guard would take for a dead audio thread is refused, with its line",
          "[rig]") {
  const auto with_period = [](int frames) {
    return "rate_Hz = 192000\nperiod_frames = " + std::to_string(frames);
  };
  CHECK(problems("rate_Hz = 192000", with_period(9600)).empty());
  const auto before = source().substr(0, source().find("rate_Hz = 192000"));
  const auto line = std::count(before.begin(), before.end(), '\n') + 2;
  for (const int frames : {9601, 19200, 65536}) {
    const auto why = problems("rate_Hz = 192000", with_period(frames));
    CAPTURE(why);
    CHECK(contains(why, "r.toml:" + std::to_string(line) + ":"));
    CHECK(contains(why, "at most 50 ms: 9600 frames"));
  }
}

TEST_CASE("tables beside the rig file are read, and their rows checked", "[rig]") {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  const auto path = folder / "rig.toml";
  const auto parsed = [&] {
    auto text = replaced(source(), "um_per_full_scale = 4.0", "response_csv = \"response.csv\"");
    text = replaced(text,
                    "model = \"load-sharing\"        # illustrative: a live session needs a measured table\n"
                    "pressure_kPa = 5\nfloor = 0.1\n",
                    "table_csv = \"friction.csv\"\n");
    return rig::parse(text, path);
  };
  write("response.csv", "# swept\nfrequency_Hz,um_per_full_scale,phase_deg\n14000,4,0\n60000,2,-180\n");
  write("friction.csv", "displacement_um,relative_friction\n0,1\n1,0.4\n3,0.2\n");
  const auto rig = parsed();
  REQUIRE(rig.transducers[0].response.size() == 2);
  CHECK(rig.transducers[0].response[1].phase_rad == Approx(-std::acos(-1.0)));
  CHECK(rig.friction.measured);
  CHECK(rig.friction.table.at(1).second == Approx(0.4));
  SECTION("spreadsheets write a byte order mark, semicolons, tabs and decimal commas") {
    write("response.csv",
          "\xEF\xBB\xBF"
          "frequency_Hz;um_per_full_scale;phase_deg\r\n13999,5;4;0\r\n60000;2,25;-180\r\n;;\r\n");
    write("friction.csv", "displacement_um\trelative_friction\n0\t1\n1\t0,4\n3\t0,2\n");
    const auto read = parsed();
    CHECK(read.transducers[0].response[0].frequency_Hz == 13999.5);
    CHECK(read.transducers[0].response[1].m_per_full_scale == Approx(2.25e-6));
    CHECK(read.friction.table.at(1).second == Approx(0.4));
    write("friction.csv", "\"displacement_um\";\"relative_friction\"\n0;1\n1;0.4\n3;0.2\n");
    CHECK(parsed().friction.table.at(1).second == Approx(0.4));
  }
  SECTION("in a file with decimal commas points are refused, because they might group thousands") {
    write("response.csv", "frequency_Hz;um_per_full_scale;phase_deg\n14.000;4,5;0\n60.000;2;-180\n");
    try {
      parsed();
      FAIL("the points were accepted");
    } catch (const text::BadInput& error) {
      CHECK(contains(error.what(), "decimal commas, so its numbers may not have points"));
    }
  }
  SECTION("a friction that grows with the displacement is refused") {
    write("friction.csv", "displacement_um,relative_friction\n0,0.5\n1,0.6\n");
    CHECK_THROWS_AS(parsed(), text::BadInput);
  }
  SECTION("a response that does not cover the band is refused") {
    write("response.csv", "frequency_Hz,um_per_full_scale,phase_deg\n14000,4,0\n50000,2,0\n");
    CHECK_THROWS_AS(parsed(), text::BadInput);
  }
  SECTION("a cell that is no number is refused") {
    write("response.csv", "frequency_Hz,um_per_full_scale,phase_deg\n14000,4,0\n60000,two,0\n");
    CHECK_THROWS_AS(parsed(), text::BadInput);
  }
}

TEST_CASE("a rig file that is missing, or is a folder, is bad input", "[rig]") {
  CHECK_THROWS_AS(rig::load("no/such/rig.toml"), text::BadInput);
  CHECK_THROWS_AS(rig::load("/tmp"), text::BadInput);
}
