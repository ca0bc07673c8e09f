#include "station/protocol/survey.hpp"

#include <algorithm>
#include <filesystem>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/design_advice.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

const std::string root = TURNPOINT_SOURCE_DIR;

std::string source(const std::string& name) { return core::read_file(root + "/protocols/" + name); }
rig::Rig simulated() { return rig::load(root + "/deploy/rigs/simulated.toml"); }

rig::Rig following() { return rig::load(root + "/deploy/rigs/simulated-following.toml"); }

std::string all_of(const std::vector<core::Problem>& problems) {
  std::string all;
  for (const auto& problem : problems) all += format(problem) + "\n";
  return all;
}

std::string problems(const std::string& protocol_text, const rig::Rig& rig) {
  return all_of(protocol::survey(protocol::parse(protocol_text, "p.toml"), rig).problems);
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

/// Returns the rig with the pick-ups, force cells and headphones of simulated-forces.toml added.
rig::Rig with_cells(rig::Rig rig) {
  const auto other = rig::load(root + "/deploy/rigs/simulated-forces.toml");
  rig.capture = other.capture, rig.noise = other.noise;
  return rig;
}

void check_shipped(const rig::Rig& rig) {
  for (const auto* folder : {"/protocols", "/protocols/gallery"})
    for (const auto& entry : fs::directory_iterator(root + folder)) {
      if (entry.path().extension() != ".toml") continue;
      INFO(entry.path().string());
      const auto protocol = protocol::load(entry.path().string());
      const bool follows = std::any_of(protocol.scenes.begin(), protocol.scenes.end(),
                                       [](const auto& scene) { return scene.second.follow.has_value(); });
      const bool more = protocol.sensing || protocol.task.sound == protocol::Sound::masking_noise;
      const auto survey = protocol::survey(protocol, follows ? following() : more ? with_cells(rig) : rig);
      CHECK(all_of(survey.problems) == "");
      CHECK(all_of(survey.warnings) == "");
      CHECK_FALSE(survey.sights.empty());
      for (const auto& sight : survey.sights) CHECK(sight.inside_tolerance);
    }
}

}  // namespace

TEST_CASE("every shipped protocol can be run, without a warning, on a rig like the simulated one",
          "[protocol]") {
  check_shipped(quick_rig());
}

TEST_CASE("a protocol that watches the finger needs force cells, and real ones need a calibration",
          "[protocol]") {
  const auto protocol = protocol::load(root + "/protocols/friction-measured.toml");
  const auto found = [&](const rig::Rig& rig) { return all_of(protocol::survey(protocol, rig).problems); };
  auto rig = with_cells(quick_rig());
  CHECK(found(rig) == "");
  rig.capture->uri = "alsa:hw:1";
  CHECK(contains(found(rig), "the rig's force cells are not calibrated"));
  rig.capture->forces = rig::ForceCells{};
  CHECK(found(rig) == "");
  rig.capture->bridges.clear();
  CHECK(contains(found(rig), "the rig has no force cells"));
}

TEST_CASE("a scene that follows the finger is refused at its line on a rig that cannot",
          "[protocol][follow]") {
  const auto text = source("grating-periods.toml");
  CHECK(problems(text, following()) == "");
  const auto cells_only = with_cells(simulated());
  const auto refused = problems(text, cells_only);
  CAPTURE(refused);
  const auto line =
      std::count(text.begin(), text.begin() + static_cast<long>(text.find("follow = {")), '\n') + 1;
  CHECK(contains(refused, "p.toml:" + std::to_string(line) + ":"));
  CHECK(contains(refused, "scene \"standard\" in block \"practice\""));
  CHECK(contains(refused, "give \"cells_resonance_Hz\" in [capture]"));
  auto slow = following();
  slow.output.period_frames = 384, slow.output.periods = 4;
  CHECK(contains(problems(text, slow), "10.87 ms from the finger's place to the amplitude"));
}

TEST_CASE("values of a factor that no pattern can have are a problem at the line of follow",
          "[protocol][follow]") {
  // the ends of the range are possible, the middle is not: a texture in time with 0 Hz
  auto text = replaced(source("grating-periods.toml"), "range = [0.0, 4.0]", "range = [-4.0, 4.0]");
  text = replaced(text, "period_mm = \"6 + wider_mm\"", "frequency_Hz = \"wider_mm\"");
  text = replaced(text, "levels = [4.0]", "levels = [0.0]");
  const auto refused = problems(text, following());
  CAPTURE(refused);
  CHECK(contains(refused, "a texture needs cycles_per_m or cycles_per_s"));
  const auto line =
      std::count(text.begin(), text.begin() + static_cast<long>(text.rfind("follow = {")), '\n') + 1;
  CHECK(contains(refused, "p.toml:" + std::to_string(line) + ":"));
}

TEST_CASE("noises are refused if they need too many samples together, or have power at no whole cycle",
          "[protocol][follow]") {
  const auto with = [](const std::string& one, const std::string& other) -> std::string {
    try {
      return problems(replaced(source("grating-periods.toml"), "follow = { friction = 1.0, parts = [",
                               "follow = { friction = 1.0, parts = [" + one + other),
                      following());
    } catch (const std::exception& error) {
      return error.what();
    }
  };
  const auto noise = [](const std::string& period, const std::string& low, const std::string& high) {
    return "{ shape = \"noise\", from = 0.5, to = 0.6, period_mm = " + period +
           ", spectrum = [{ cycles_per_mm = " + low + ", density = 1.0 }, { cycles_per_mm = " + high +
           ", density = 1.0 }], begin_mm = 35.0, end_mm = 115.0 },";
  };
  const auto long_one = noise("80.0", "0.5", "2.0");  // 1280 samples
  CHECK(with(long_one, "") == "");
  CHECK(contains(with(long_one, long_one), "have more than 2048 samples"));
  CHECK(contains(with(noise("10.0", "0.11", "0.19"), ""), "no power at any whole number of cycles"));
}

TEST_CASE("where a scene cannot reach what it asks for everywhere, the check says so and lets it be",
          "[protocol][follow]") {
  const auto text =
      replaced(source("edge-anywhere.toml"), "follow = { friction = 1.0", "follow = { friction = 0.8");
  const auto survey = protocol::survey(protocol::parse(text, "p.toml"), following());
  CHECK(all_of(survey.problems) == "");
  const auto told = all_of(survey.warnings);
  CAPTURE(told);
  CHECK(contains(told, "relative friction 0.8 is asked for, and from 1 to 1 is reached"));
}

TEST_CASE("the rig is asked for calibrated cells if it is a real one and a scene follows",
          "[protocol][follow]") {
  auto protocol = protocol::load(root + "/protocols/grating-periods.toml");
  protocol.sensing.reset();
  auto rig = following();
  rig.capture->uri = "alsa:hw:1";
  CHECK(contains(all_of(protocol::survey(protocol, rig).problems), "force cells are not calibrated"));
  rig.capture->forces = rig::ForceCells{};
  CHECK(all_of(protocol::survey(protocol, rig).problems) == "");
}

TEST_CASE("tones whose products come near the carrier of the force cells give a warning with the figures",
          "[protocol]") {
  const auto warnings = [](const rig::Rig& rig, const std::string& second_Hz) {
    const auto text = replaced(
        source("demo.toml"), "boundary_mm = \"mark_mm + offset_mm\"\nedge = \"p50\"\ndisplacement_um = 1.0\n",
        "tones = [{ frequency_Hz = 30000, displacement_um = 0.5 }, { frequency_Hz = " + second_Hz +
            ", displacement_um = 0.5 }]\n");
    return all_of(
        protocol::survey(protocol::parse(replaced(text, "boundary_mm = 0.5, ", ""), "p.toml"), rig).warnings);
  };
  auto rig = with_cells(quick_rig());
  const auto told = warnings(rig, "33400");
  CAPTURE(told);
  CHECK(contains(told, "p.toml:24:"));
  CHECK(contains(
      told,
      "scene \"edge\" in block \"main\": 3 x 33400 Hz - 3 x 30000 Hz = 10200 Hz is only 325 Hz from the "
      "carrier of the force cells (10525 Hz)"));
  CHECK(contains(told, "an oscillation of the force"));
  CHECK(contains(told, "that of 33400 Hz to 33308 Hz or lower"));
  CHECK_FALSE(contains(warnings(rig, "33308"), "carrier"));
  // 3 x 3376 Hz is 397 Hz from the carrier, 3 x 3374 Hz is 403 Hz from it
  CHECK(contains(warnings(rig, "33376"), "carrier"));
  CHECK_FALSE(contains(warnings(rig, "33374"), "carrier"));
  CHECK_FALSE(contains(warnings(quick_rig(), "33400"), "carrier"));
  rig.capture->forces = rig::ForceCells{};
  rig.capture->forces->carrier_Hz = 8425;
  CHECK_FALSE(contains(warnings(rig, "33400"), "carrier"));
  rig.capture->bridges.clear();
  CHECK_FALSE(contains(warnings(rig, "33400"), "carrier"));
}

TEST_CASE("every shipped protocol can be run on the simulated rig, without a warning", "[protocol]") {
  check_shipped(simulated());
}

TEST_CASE("a survey plans each combination of level and mark once, with its boundary", "[protocol]") {
  const auto survey = protocol::survey(protocol::parse(source("demo.toml"), "p.toml"), quick_rig());
  CHECK(survey.combinations == 10);
  REQUIRE(survey.sights.size() == 10);
  for (const auto& sight : survey.sights) {
    const double mark = std::get<double>(sight.factors.at("mark_mm"));
    const double offset = std::get<double>(sight.factors.at("offset_mm"));
    REQUIRE(sight.boundary_mm.has_value());
    CHECK(*sight.boundary_mm == Approx(mark + offset).margin(0.5));
  }
}

TEST_CASE("if the rig cannot reach a boundary, the message says which boundaries it can reach",
          "[protocol]") {
  auto text = replaced(source("demo.toml"), "levels = [150.0, 160.0]", "levels = [250.0, 260.0]");
  const auto found = problems(text, quick_rig());
  CHECK(contains(found, "p.toml:25:15: scene \"edge\" in block \"main\" at mark_mm = 250, offset_mm = "));
  CHECK(contains(found, "more cases"));
  CHECK(contains(found, "with this edge the rig can present boundaries from"));
}

TEST_CASE("a displacement above the rig's limit is refused, roving included", "[protocol]") {
  const auto quiet = replaced(source("demo.toml"), "rove_dB = 2.0", "rove_dB = 0.0");
  const auto limit = replaced(quick_rig_source(), "displacement_um = 8.0", "displacement_um = 4.0");
  const auto rig = rig::parse(limit, "r.toml");
  const auto peak = protocol::survey(protocol::parse(quiet, "p.toml"), rig);
  REQUIRE(peak.problems.empty());
  double largest_um = 0;
  for (const auto& sight : peak.sights) largest_um = std::max(largest_um, sight.displacement_um);
  const auto tight = rig::parse(replaced(quick_rig_source(), "displacement_um = 8.0",
                                         "displacement_um = " + std::to_string(1.05 * largest_um)),
                                "r.toml");
  CHECK(problems(quiet, tight).empty());
  CHECK(contains(problems(replaced(quiet, "rove_dB = 0.0", "rove_dB = 6.0"), tight), "the rig's limit is"));
}

TEST_CASE("devices that the task needs and the rig lacks are named at the key that asks for them",
          "[protocol]") {
  const auto buttons = replaced(source("demo.toml"), "device = \"either\"", "device = \"buttons\"");
  const auto without = rig::parse(replaced(quick_rig_source(), "[buttons]\nuri = \"sim:\"\n", ""), "r.toml");
  CHECK(contains(problems(buttons, without), "p.toml:35:10: the task needs buttons, but the rig has none"));
  CHECK(problems(source("demo.toml"), without).empty());
  const auto no_contact =
      rig::parse(replaced(quick_rig_source(), "[contact]\nuri = \"sim:\"\n", ""), "r.toml");
  const auto lift =
      replaced(source("demo.toml"), "response_zero = \"go_cue\"", "response_zero = \"lift_off\"");
  CHECK(contains(problems(lift, no_contact), "the rig cannot sense contact"));
  CHECK(problems(lift, quick_rig()).empty());
  const auto masked =
      replaced(buttons, "device = \"buttons\"", "device = \"buttons\"\nsound = \"masking_noise\"");
  CHECK(contains(problems(masked, quick_rig()),
                 "p.toml:36:9: the task needs masking noise, but the rig has none"));
  const auto headphones = rig::parse(
      replaced(quick_rig_source(), "[limits]", "[noise]\nchannel = 1\nrms = 0.05\n[limits]"), "r.toml");
  CHECK(problems(masked, headphones).empty());
  const auto by_tone =
      replaced(source("response-signal.toml"), "window_s = 0.4", "window_s = 0.4, by = \"tone\"");
  CHECK(contains(problems(by_tone, headphones),
                 "p.toml:51:61: the response signal is a tone, but the rig has none"));
  const auto tone = rig::parse(
      replaced(
          quick_rig_source(), "[limits]",
          "[noise]\nchannel = 1\nrms = 0.05\nsignal = { frequency_Hz = 1000, amplitude = 0.2 }\n[limits]"),
      "r.toml");
  CHECK(problems(by_tone, tone).empty());
}

TEST_CASE("tones that last longer than the rig allows are refused", "[protocol]") {
  const auto text = replaced(source("demo.toml"), "explore_s = 4.0", "explore_s = 40.0");
  CHECK(contains(problems(text, quick_rig()), "the rig allows at most continuous_s = 30 s"));
}

TEST_CASE("a probable mistake gives a warning at its place", "[protocol]") {
  const auto advice = [](const std::string& text) {
    return all_of(protocol::advice(protocol::parse(text, "p.toml")));
  };
  const auto constant = source("boundary-constant.toml");
  SECTION("labels of a rating and of confidence that nobody can tell apart") {
    const auto rating = source("friction-rating.toml");
    CHECK(contains(advice(replaced(rating, "en = \"surely not\"", "en = \"  \"")),
                   "the label of \"1\" is blank"));
    CHECK(contains(advice(replaced(rating, "en = \"surely not\"", "en = \"surely\"")),
                   "two answers have the label \"surely\""));
  }
  SECTION("standards that are felt after the last trial") {
    const auto source_of = source("bisection.toml");
    const std::string what = "the examples of \"standards\" come after the last block";
    CHECK_FALSE(contains(advice(source_of), what));
    const auto from = source_of.find("[[explanation]]"), to = source_of.find("[[block]]");
    REQUIRE(from < to);
    const auto moved =
        source_of.substr(0, from) + source_of.substr(to) + "\n" + source_of.substr(from, to - from);
    CHECK(contains(advice(moved), what));
    CHECK_FALSE(contains(
        advice(replaced(moved, "name = \"standards\"", "name = \"standards\"\nafter_each = \"main\"")),
        what));
  }
  SECTION("levels finer than four times the tolerance") {
    CHECK(contains(advice(replaced(constant, "boundary_mm = 0.5,", "boundary_mm = 1.0,")),
                   "the scene's tolerance is 1 mm"));
  }
  SECTION("levels that everybody feels") {
    const auto coarse =
        replaced(source("friction-same-different.toml"), "[-20.0, -14.0, -9.0, -4.0]", "[-8.0, -4.0]");
    CHECK(contains(advice(coarse), "which everybody feels"));
  }
  SECTION("practice that can be passed with one key") {
    CHECK(contains(advice(replaced(constant, "levels = [-28.0, 28.0]", "levels = [20.0, 28.0]")),
                   "can be passed by always pressing the same key"));
    CHECK(contains(advice(replaced(constant, "accuracy = 0.75", "accuracy = 0.5")),
                   "can be passed by always pressing the same key"));
  }
  SECTION("catch trials with one right answer") {
    const auto text =
        replaced(source("boundary-adaptive.toml"), "offset_mm = [-24.0, 24.0] }", "offset_mm = 24.0 }");
    CHECK(contains(advice(text), "have only one right answer"));
  }
  SECTION("a grid of one stimulus") {
    const auto text =
        replaced(source("friction-2ifc.toml"), "stimuli = { from = -30.0, to = -3.0, step = 1.0 }",
                 "stimuli = { values = [-20.0] }");
    CHECK(contains(advice(text), "the grid has only one point"));
  }
  SECTION("unequal steps whose target is not the usual one") {
    const auto text = replaced(source("friction-staircase.toml"), "step = [4.0, 2.0, 1.0]",
                               "step_down = [1.0]\nstep_up = [2.0]");
    CHECK(contains(advice(text), "let it converge near 87.4 % right"));
  }
  SECTION("parts that nothing uses") {
    CHECK(contains(advice(replaced(constant, "[scene.edge]",
                                   "[[factor]]\nname = \"spare\"\nlevels = [1, 2]\n[scene.edge]")),
                   "the factor \"spare\" is not used"));
  }
}

TEST_CASE("counts that balance cannot make equal are noted, for one factor and for several together",
          "[protocol]") {
  const auto notes = [](const std::string& balance, const std::string& repeats) {
    auto text = replaced(source("boundary-constant.toml"), "[scene.edge]",
                         "[[factor]]\nname = \"hand\"\nlevels = [1, 2]\n"
                         "[[factor]]\nname = \"speed\"\nlevels = [1, 2, 3, 4]\n[scene.edge]");
    text = replaced(text, "balance = [\"mark_mm\"]", "balance = " + balance);
    return all_of(protocol::notes(
        protocol::parse(replaced(text, "repeats = 10\n", "repeats = " + repeats + "\n"), "p.toml")));
  };
  const auto one_line = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n') == 1;
  };
  SECTION("one factor") {
    const auto mark = "[\"mark_mm\"]";
    CHECK(notes(mark, "9").empty());
    const auto said = notes(mark, "10");
    CHECK(contains(said, "p.toml:65:"));
    CHECK(contains(said,
                   "each level is combined with each of the 3 values of \"mark_mm\" 3 or 4 times; "
                   "for equal counts, set repeats = 12"));
    CHECK(one_line(said));
  }
  SECTION("two factors whose combinations are uneven though each factor is even") {
    const auto both = "[\"mark_mm\", \"hand\"]";
    CHECK(notes(both, "12").empty());
    const auto more = notes("[\"hand\", \"speed\"]", "12");
    CHECK(contains(
        more,
        "each level is combined with each of the 8 combinations of \"hand\" and \"speed\" 1 or 2 times; "
        "for equal counts, set repeats = 16"));
    CHECK(one_line(more));
  }
  SECTION("more combinations than repeats") {
    const auto said = notes("[\"mark_mm\", \"hand\", \"speed\"]", "12");
    CHECK(contains(said,
                   "each of the 24 combinations of \"mark_mm\", \"hand\" and \"speed\" 0 or 1 times; "
                   "for equal counts, set repeats = 24"));
    CHECK(one_line(said));
  }
  SECTION("combinations that no number of repeats makes equal") {
    std::string levels = "[1";
    for (int i = 2; i <= 1500; ++i) levels += ", " + std::to_string(i);
    auto text = replaced(source("boundary-constant.toml"), "[scene.edge]",
                         "[[factor]]\nname = \"many\"\nlevels = " + levels +
                             "]\n[[factor]]\nname = \"more\"\nlevels = " + levels + "]\n[scene.edge]");
    text = replaced(text, "balance = [\"mark_mm\"]", "balance = [\"many\", \"more\"]");
    CHECK(contains(
        all_of(protocol::notes(protocol::parse(text, "p.toml"))),
        "each of the 2250000 combinations of \"many\" and \"more\" 0 or 1 times; use fewer factors or "
        "fewer levels"));
  }
}

TEST_CASE("a level that is listed several times is noted once, with how often it comes", "[protocol]") {
  const auto notes = all_of(protocol::notes(protocol::parse(source("friction-detection.toml"), "p.toml")));
  CHECK(contains(notes, "the level 0 is listed 3 times, so it is presented 3 times as often"));
  CHECK(notes.find("is listed") == notes.rfind("is listed"));
}
