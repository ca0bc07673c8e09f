#include <fstream>
#include <iterator>

#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

constexpr int kPatience_ms = 20000;
const std::string kRig = std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml";

/// Checks the program's message and exit status for this command line.
void check_refused(std::vector<std::string> arguments, const std::string& why) {
  arguments.insert(arguments.begin(), TURNPOINT);
  Child child(arguments);
  REQUIRE(child.ends_within(kPatience_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == 2);
  CHECK(child.said().find(why) != std::string::npos);
}

}  // namespace

TEST_CASE("nothing is played unless the operator has armed the amplifier, nor for longer than the rig allows",
          "[cli]") {
  check_refused({"synth", "--rig", kRig, "--tone", "30000", "--seconds", "2", "--out", "null:", "--arm"},
                "synth: --arm with --out null:; --arm is only possible with --out alsa:NAME, which plays "
                "through the amplifier");
  check_refused(
      {"synth", "--rig", kRig, "--tone", "30000", "--seconds", "31", "--out", "alsa:hw:9", "--arm"},
      "synth: with --arm for 31 s the amplifier would run too long; the rig allows 30 s without a pause");
  check_refused({"calibrate", "--rig", kRig, "--sweep", "--sweep-out", "alsa:hw:9"},
                "calibrate: --sweep-out alsa:hw:9 plays through the amplifier; make sure that nobody touches "
                "the surface, and add --arm");
}

TEST_CASE("the doctor warns of a simulated panel beside a real converter", "[cli]") {
  const TemporaryFolder folder;
  const auto rig = folder / "rig.toml";
  std::ifstream simulated(kRig);
  std::string text{std::istreambuf_iterator<char>(simulated), {}};
  const std::string warning = "the touch panel is simulated, so touches have no kernel time stamps";
  for (const char* output : {"null:", "alsa:hw:31"}) {  // the card hw:31 does not exist
    const auto uri = text.find("uri = \"null:\"");
    if (uri != std::string::npos) text.replace(uri, 13, std::string("uri = \"") + output + "\"");
    std::ofstream(rig) << text;
    Child child({TURNPOINT, "doctor", "--rig", rig, "--data", folder.path});
    REQUIRE(child.ends_within(kPatience_ms));
    CAPTURE(child.said());
    CHECK((child.said().find(warning) != std::string::npos) == (std::string(output) != "null:"));
  }
}

TEST_CASE("amplifier-off accepts the options of the station, and uses the station's rig", "[cli]") {
  const TemporaryFolder folder;
  Child child({TURNPOINT, "amplifier-off", "--locked", "--protocols", folder / "protocols", "--db",
               folder / "lab.sqlite", "--rig", kRig});
  REQUIRE(child.ends_within(kPatience_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == 0);
  CHECK(child.said().find("amplifier off: sim:, of " + kRig) != std::string::npos);
}

TEST_CASE("the doctor uses the same rig as the other commands", "[cli]") {
  const TemporaryFolder folder;
  Child child({TURNPOINT, "doctor"}, {"XDG_DATA_HOME=" + (folder / "data")});
  REQUIRE(child.ends_within(kPatience_ms));
  CAPTURE(child.said());
  CHECK(child.said().find(" (no --rig was given)") != std::string::npos);
  CHECK(child.said().find("MiB free in " + folder.path) != std::string::npos);
}
