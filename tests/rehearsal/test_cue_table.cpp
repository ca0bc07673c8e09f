#include "station/rehearsal/cue_table.hpp"

#include "station/protocol/resolve.hpp"
#include "station/scene/planner.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;

namespace {

std::string source(const std::string& name) {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name);
}

}  // namespace

TEST_CASE("the cues of a scene equal those of the planner for every strength that is drawn", "[cues]") {
  auto text = source("boundary-constant.toml");
  const auto by_friction = replaced(text, "edge = \"p50\"", "edge = { friction = 0.8 }");
  for (const auto& edge : {text, by_friction}) {
    const auto protocol = protocol::parse(edge, "p.toml");
    rehearsal::CueTable table(protocol, quick_rig(), protocol::survey(protocol, quick_rig()));
    scene::Planner planner(quick_rig());
    for (const double rove_dB : {-2.0, -0.7, 0.0, 1.3})
      for (const double offset : {-26.0, -8.0, 1.0, 12.0}) {
        const protocol::Factors factors{{"mark_mm", 158.0}, {"offset_mm", offset}};
        const auto expected = planner.plan(protocol::resolve(protocol, "edge", factors, rove_dB)).cues;
        auto found = table.find("edge", factors);
        REQUIRE(found);
        const auto cues = found->at(rove_dB);
        CHECK(cues.strip_width_m == Approx(expected.strip_width_m).epsilon(1e-3));
        CHECK(cues.wide_end_amplitude_m == Approx(expected.wide_end_amplitude_m).epsilon(0.1));
        CHECK(cues.stripe_pitch_m == Approx(expected.stripe_pitch_m).epsilon(0.1));
        CHECK(cues.edge_width_m == Approx(expected.edge_width_m).epsilon(2e-2));
      }
  }
}

TEST_CASE("the cues of a zone are interpolated between its plans", "[cues]") {
  const auto protocol = protocol::parse(source("friction-2ifc.toml"), "p.toml");
  const auto survey = protocol::survey(protocol, quick_rig());
  CHECK(survey.sights.size() < survey.combinations);
  rehearsal::CueTable table(protocol, quick_rig(), survey);
  scene::Planner planner(quick_rig());
  for (const double level : {-28.0, -17.0, -11.0, -4.0}) {
    const protocol::Factors factors{{"contrast_dB", level}};
    const auto expected = planner.plan(protocol::resolve(protocol, "comparison", factors, 0)).cues;
    const auto found = table.find("comparison", factors);
    REQUIRE(found);
    CHECK(found->at(0).wide_end_amplitude_m == Approx(expected.wide_end_amplitude_m).epsilon(0.07));
  }
  CHECK_FALSE(table.find("comparison", {{"contrast_dB", -40.0}}));
}
