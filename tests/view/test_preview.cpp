#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "station/core/usage_error.hpp"
#include "station/view/preview.hpp"
#include "station/view/scene_figures.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/svg_geometry.hpp"

using namespace turnpoint;

namespace {

const std::string kSource = TURNPOINT_SOURCE_DIR;

view::Preview preview_of(const std::string& protocol) {
  return view::Preview(protocol::load(kSource + "/protocols/" + protocol + ".toml"),
                       rig::load(kSource + "/tests/support/thin_plate.toml"));
}

protocol::Factors factors(const view::Preview& preview, const std::vector<std::string>& set) {
  std::vector<std::string> assumed;
  return view::factors_for(preview.protocol(), set, assumed);
}

/// Returns the position of the boundary in the picture of a surface. It is found by its colour, which no
/// other line has.
double boundary_x(const std::string& svg) {
  for (const auto& line : svg_geometry::elements(svg, "line"))
    if (svg_geometry::attribute(line, "stroke") == "#b3400a") return svg_geometry::number(line, "x1");
  throw std::runtime_error("no boundary drawn");
}

/// Finds words in the picture of a surface that overlap other words, the boundary or the picture's edge; ""
/// if there are none.
std::string clash(const std::string& svg, double height) {
  const auto texts = svg_geometry::texts(svg);
  const double line_x = boundary_x(svg);
  for (const auto& text : texts) {
    if (text.box.top < 0 || text.box.bottom > height) return text.words + " over the edge";
    if (text.words == "mark" && text.box.left < line_x && line_x < text.box.right)
      return "mark on the boundary";
    for (const auto& other : texts)
      if (&other != &text && svg_geometry::meet(other.box, text.box))
        return text.words + " on " + other.words;
  }
  return "";
}

}  // namespace

TEST_CASE("the preview of a scene that follows the finger draws what is asked for beside what is reached",
          "[preview]") {
  view::Preview preview(protocol::load(kSource + "/protocols/edge-anywhere.toml"),
                        rig::load(kSource + "/deploy/rigs/simulated-following.toml"));
  const auto look = preview.look("edge", factors(preview, {"edge_mm=75", "step=0.4"}));
  REQUIRE(look.problem.empty());
  REQUIRE(look.followed.size() == 1);  // no events
  const auto figure = view::profile_figure({look});
  const auto& asked = std::get<report::Line>(figure.charts.at(1).layers.at(0));
  const auto& reached = std::get<report::Line>(figure.charts.at(1).layers.at(1));
  CHECK(asked.beyond);
  CHECK_FALSE(reached.beyond);
  const auto at = [](const report::Line& line, double x_mm) {
    for (std::size_t i = 0; i < line.x.size(); ++i)
      if (line.x[i] >= x_mm) return line.y[i];
    return -1.0;
  };
  for (const auto* line : {&asked, &reached}) {
    CHECK(at(*line, 10) == Approx(1).margin(1e-6));
    CHECK(at(*line, 30) == Approx(0.75).margin(0.01));
    CHECK(at(*line, 50) == Approx(0.5).margin(1e-6));
    CHECK(at(*line, 67.5) == Approx(0.4).margin(0.01));  // half-way down to 0.3 at the edge
    CHECK(at(*line, 82.5) == Approx(0.6).margin(0.01));  // half-way back from 0.7
    CHECK(at(*line, 100) == Approx(0.5).margin(1e-6));
    CHECK(at(*line, 200) == Approx(1).margin(1e-6));
  }
  bool delay = false;
  for (const auto& [label, value] : look.facts)
    delay = delay || core::say(value, "en").starts_with("2.37 ms after it");
  CHECK(delay);
}

TEST_CASE("the chart of friction under a fingertip shows the loaded surface", "[preview]") {
  auto preview = preview_of("demo");
  const auto look = preview.look("edge", factors(preview, {}));
  const auto figure = view::profile_figure({look});
  const auto lowest = [&](std::size_t chart) {
    const auto& y = std::get<report::Line>(figure.charts.at(chart).layers.at(0)).y;
    return *std::min_element(y.begin(), y.end());
  };
  CHECK(figure.charts.at(1).title == "Friction under a fingertip");
  const auto german = view::profile_figure({look}, "de");
  CHECK(german.charts.at(1).title == "Reibung unter einer Fingerkuppe");
  CHECK(german.charts.at(0).x.label == "Abstand vom breiten Ende (mm)");
  CHECK(lowest(1) == look.under.lowest_friction);
  const auto& free = look.profile.friction;
  CHECK(lowest(1) > *std::min_element(free.begin(), free.end()) + 0.1);
}

TEST_CASE("the sliders of a scene are the factors on which it depends, with their ranges and levels",
          "[preview]") {
  const auto preview = preview_of("demo");
  const auto knobs = preview.knobs("edge");
  REQUIRE(knobs.size() == 2);
  CHECK(knobs[0].name == "offset_mm");
  CHECK(knobs[0].low == -24);
  CHECK(knobs[0].high == 24);
  CHECK(knobs[0].levels.empty());
  CHECK(knobs[1].name == "mark_mm");
  CHECK(knobs[1].levels == std::vector<double>{150, 160});
}

TEST_CASE("a preview has its boundary where the factors put it, and the displacement falls to half there",
          "[preview]") {
  auto preview = preview_of("demo");
  const auto look = preview.look("edge", factors(preview, {"offset_mm=9"}));
  REQUIRE(look.problem.empty());
  CHECK(*look.plan.boundary_m == Approx(0.159).margin(1e-4));
  const auto& profile = look.profile;
  REQUIRE(profile.x_m.size() == view::kProfilePoints);
  const auto last_peak = std::max_element(profile.displacement_m.begin(), profile.displacement_m.end());
  const auto beyond = std::lower_bound(profile.x_m.begin(), profile.x_m.end(), *look.plan.boundary_m);
  const auto at = static_cast<std::size_t>(beyond - profile.x_m.begin());
  // The boundary is that of the lossless first mode. The profile includes loss and is sampled every 0.75 mm,
  // so the two agree only roughly.
  CHECK(profile.displacement_m[at] / *last_peak == Approx(0.5).margin(0.05));
  CHECK(core::say(look.facts.front().second, "en").find("159 mm") != std::string::npos);
  CHECK_FALSE(look.cues.empty());
}

TEST_CASE("the plan and the cues of a scene are said in the language of the screen", "[preview]") {
  auto preview = preview_of("demo");
  const auto look = preview.look("edge", factors(preview, {"offset_mm=9"}));
  const auto said = [](const auto& facts, const char* language) {
    std::string all;
    for (const auto& [label, value] : facts)
      all += core::say(label, language) + ": " + core::say(value, language) + "\n";
    return all;
  };
  CHECK(said(look.facts, "en").find("Model error: at most ") != std::string::npos);
  CHECK(said(look.facts, "de").find("Modellfehler: h\u00f6chstens ") != std::string::npos);
  CHECK(said(look.facts, "de").find("\nOberfl\u00e4che: h\u00f6chstens ") != std::string::npos);
  CHECK(said(look.cues, "en").find("Stripes at the wide end: ") != std::string::npos);
  // These are the same in both languages.
  const std::set<std::string> same{"de preview.mm_sd", "es preview.inaudible"};
  for (const std::string language : {"de", "es", "ja", "zh", "ar"})
    for (const auto* facts : {&look.facts, &look.cues})
      for (const auto& [label, value] : *facts)
        if (!value.key.empty() && same.count(language + " " + value.key) == 0)
          CHECK(core::say(value, language) != core::say(value, "en"));
  CHECK(view::spectrum_figure(look, "de").charts.front().title == "Ansteuerung");
}

TEST_CASE("the tolerance that a cheaper model would miss is named with both figures, and no other",
          "[preview]") {
  const auto cheaper = [](const protocol::Tolerance& tolerance, const char* language) {
    auto protocol = protocol::load(kSource + "/protocols/demo.toml");
    protocol.scenes.at("edge").tolerance = tolerance;
    view::Preview preview(protocol, rig::load(kSource + "/tests/support/thin_plate.toml"));
    const auto look = preview.look("edge", factors(preview, {"offset_mm=9"}));
    for (const auto& [label, value] : look.facts)
      if (label.key == "preview.cheaper") return core::say(value, language);
    return std::string();
  };
  const auto has = [](const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
  };
  // beside a coarse two-dimensional field, "mode" misses the level by up to 0.9 dB
  const auto by_level = cheaper({0.5, 0.3, {}}, "en");
  CAPTURE(by_level);
  CHECK(by_level.starts_with("mode would miss the scene's tolerance: level up to 0."));
  CHECK(by_level.ends_with(" dB, tolerance 0.3 dB"));
  const auto by_boundary = cheaper({0.001, 3, {}}, "en");
  CAPTURE(by_boundary);
  CHECK(has(by_boundary, "boundary up to 0.0"));
  CHECK(by_boundary.ends_with(" mm, tolerance 0.001 mm"));
  CHECK_FALSE(has(by_boundary, "level"));
  const auto by_friction = cheaper({{}, {}, 0.02}, "en");
  CAPTURE(by_friction);
  CHECK(has(by_friction, "amplitude up to "));
  CHECK(by_friction.ends_with(" % (friction 0.02)"));
  CHECK(has(cheaper({0.5, 0.3, {}}, "de"), "verfehlt die Toleranz der Szene: Pegel bis zu 0."));
  CHECK(cheaper({}, "en").empty());
}

TEST_CASE("what a rig cannot present is reported as a problem of the preview, in words", "[preview]") {
  auto preview = preview_of("demo");
  const auto look = preview.look("edge", factors(preview, {"mark_mm=290"}));
  CHECK_FALSE(look.problem.empty());
  CHECK(look.facts.empty());
  CHECK_THROWS_AS(view::surface_svg(look, preview.rig()), std::invalid_argument);
  CHECK_THROWS_AS(preview.look("nowhere", {}), std::out_of_range);
}

TEST_CASE("factors that are set must exist and be numbers", "[preview]") {
  const auto preview = preview_of("demo");
  CHECK_THROWS_AS(factors(preview, {"offset_mm"}), core::UsageError);
  CHECK_THROWS_AS(factors(preview, {"offset=3"}), core::UsageError);
  CHECK_THROWS_AS(factors(preview, {"offset_mm=left"}), core::UsageError);
  std::vector<std::string> assumed;
  view::factors_for(preview.protocol(), {"offset_mm=3"}, assumed);
  CHECK(assumed == std::vector<std::string>{"mark_mm"});
}

TEST_CASE("in the picture of a surface no text overlaps other text or the boundary, wherever the mark is",
          "[preview]") {
  auto preview = preview_of("demo");
  auto look = preview.look("edge", factors(preview, {}));
  const auto [width, height] =
      GENERATE(std::pair{240.0, 84.0}, std::pair{700.0, 130.0}, std::pair{900.0, 400.0});
  for (double boundary_mm = 40; boundary_mm <= 260; boundary_mm += 10.37)
    for (double off_mm = -60; off_mm <= 60; off_mm += 1.5) {
      look.plan.boundary_m = 1e-3 * boundary_mm;
      const double mark_mm = boundary_mm + off_mm;
      if (mark_mm < 20 || mark_mm > 280) continue;
      look.factors["mark_mm"] = mark_mm;
      const auto svg = view::surface_svg(look, preview.rig(), width, height);
      CAPTURE(width, height, boundary_mm, mark_mm);
      REQUIRE(clash(svg, height).empty());
    }
}

TEST_CASE("the same preview gives the same picture, and another boundary gives another picture",
          "[preview]") {
  auto preview = preview_of("demo");
  const auto draw = [&](const std::string& offset) {
    return view::surface_svg(preview.look("edge", factors(preview, {"offset_mm=" + offset})), preview.rig());
  };
  CHECK(draw("9") == draw("9"));
  CHECK(draw("9") != draw("-9"));
  const auto look = preview.look("edge", factors(preview, {}));
  CHECK(report::render(view::profile_figure({look})).find("<svg") != std::string::npos);
  CHECK(view::spectrum_figure(look).charts.front().layers.size() >= 1);
}
