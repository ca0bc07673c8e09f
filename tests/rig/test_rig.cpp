#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "station/rig/rig.hpp"
#include "tests/rig/rig_sample.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace rig_sample;

TEST_CASE("the simulated rig loads in SI units", "[rig]") {
  const auto rig = rig::load(simulated);
  CHECK(rig.name == "Aluminium tapered plate, simulated");
  CHECK(rig.surface.thickness_m == Approx(3e-3));
  CHECK(rig.surface.modulus_Pa.value() == Approx(69e9));
  CHECK(rig.surface.yield_Pa.value() > 1e8);
  CHECK(rig.surface.edges == rig::Edges::clamped);
  CHECK(rig.surface.plate_theory == rig::PlateTheory::automatic);
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
  CHECK(rig.sha256 == rig::parse(core::read_file(simulated), "elsewhere").sha256);
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
  CHECK_THROWS_AS(with("converter_delay_ms = -0.1"), core::BadInput);
  CHECK_THROWS_AS(with("converter_delay_ms = \"0.1\""), core::BadInput);
}

TEST_CASE("all mistakes in a rig file are reported at once, each with its line", "[rig]") {
  auto bad = replaced(source(), "thickness_mm = 2.0", "thicknes_mm = 2.0");
  bad = replaced(bad, "slope = 0.03", "slope = -0.03");
  bad = replaced(bad, "channel = 0", "channel = \"0\"");
  try {
    rig::parse(bad, "r.toml");
    FAIL("the file has three mistakes");
  } catch (const core::BadInput& error) {
    const std::string all = error.what();
    // the misspelt key causes two problems: it is unknown, and the right key is missing
    CHECK(error.problems().size() == 4);
    CHECK(contains(all,
                   "r.toml:12:1: unknown key \"thicknes_mm\" in [surface]; did you mean \"thickness_mm\"?"));
    CHECK(contains(all, "[surface] needs the key \"thickness_mm\""));
    CHECK(contains(all, "r.toml:27:9: \"slope\" is -0.03; allowed: above 0 and at most 1"));
    CHECK(contains(all, "r.toml:36:11: \"channel\" is the text \"0\"; a whole number from 0 to 7 is needed"));
  }
}

TEST_CASE("invalid values in a rig file are refused, with what is allowed", "[rig]") {
  CHECK(contains(problems("rate_Hz = 192000", "rate_Hz = 96000"),
                 "it may extend at most to 0.45 of rate_Hz, which is 43.2 kHz"));
  CHECK(contains(problems("\"null:\"", "\"pulse:\""), "allowed: \"null:\", \"wav:FILE\" or \"alsa:DEVICE\""));
  CHECK(contains(problems("length_mm = 300", "length_mm = 500"), "before the end of the surface"));
  CHECK(contains(problems("slope = 0.03", "slope = 0.03\ndecay_length_mm = 300"),
                 "has 2 of \"slope\", \"decay_length_mm\" or \"profile_mm\""));
  CHECK(contains(problems("slope = 0.03", ""), "has 0 of \"slope\""));
  CHECK(contains(problems("quality_factor = 30", "quality_factor = nan"), "\"quality_factor\" is nan"));
  CHECK(contains(problems("\"aluminium\"", "\"aluminum\""), "did you mean \"aluminium\"?"));
  CHECK(contains(problems("band_kHz = [14, 60]", "band_kHz = [60, 14]"), "the smaller first"));
  CHECK(contains(problems("tension_Pa = 0 ", "tension_Pa = inf "), "\"tension_Pa\" is inf"));
  CHECK(contains(problems("model = \"load-sharing\"", "table_csv = \"none.csv\""), "cannot read"));
  CHECK(contains(problems("friction-rig/1", "friction-rig/2"), "allowed: \"friction-rig/1\""));
  CHECK(contains(problems("[amplifier]\nuri = \"sim:\"", "[amplifier]\nuri = \"gpio:fault=A\""),
                 "no line \"enable\""));
  CHECK(contains(problems("[surface]", "[surface"), "not valid TOML"));
  CHECK(problems("quality_factor = 30", "quality_factor = inf").empty());
  CHECK(contains(problems("quality_factor = 30", "quality_factor = inf\nquality_factor_sd = 8"),
                 "the surface is lossless"));
  const std::string theory = "plate_theory = \"kirchhoff\"", held = "edges = \"clamped\"\n";
  CHECK(problems(theory, "plate_theory = \"mindlin\"").empty());
  CHECK(contains(problems(held + theory, "edges = \"supported\"\nplate_theory = \"elastic\""),
                 "\"plate_theory\" is \"elastic\" on this surface"));
  CHECK(contains(problems(theory, "plate_theory = \"thick\""), "mindlin"));
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
  CHECK_THROWS_AS(rig::parse(without, "r.toml"), core::BadInput);
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
    } catch (const core::BadInput& error) {
      CHECK(contains(error.what(), "decimal commas, so its numbers may not have points"));
    }
  }
  SECTION("a friction that grows with the displacement is refused") {
    write("friction.csv", "displacement_um,relative_friction\n0,0.5\n1,0.6\n");
    CHECK_THROWS_AS(parsed(), core::BadInput);
  }
  SECTION("a response that does not cover the band is refused") {
    write("response.csv", "frequency_Hz,um_per_full_scale,phase_deg\n14000,4,0\n50000,2,0\n");
    CHECK_THROWS_AS(parsed(), core::BadInput);
  }
  SECTION("a cell that is no number is refused") {
    write("response.csv", "frequency_Hz,um_per_full_scale,phase_deg\n14000,4,0\n60000,two,0\n");
    CHECK_THROWS_AS(parsed(), core::BadInput);
  }
}

TEST_CASE("a rig file that is missing, or is a folder, is bad input", "[rig]") {
  CHECK_THROWS_AS(rig::load("no/such/rig.toml"), core::BadInput);
  CHECK_THROWS_AS(rig::load("/tmp"), core::BadInput);
}
