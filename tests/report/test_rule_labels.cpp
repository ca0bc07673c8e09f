#include <cmath>

#include "station/report/chart.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/svg_geometry.hpp"

using namespace turnpoint::report;

namespace {

/// In a rendered picture, only labels of rules have this text size, and only the axes have this colour.
constexpr double kLabelSize = 11;
const std::vector<std::string> kAxes{"#222222"};

int labels_on(const std::string& svg) {
  const auto all = svg_geometry::texts(svg);
  return static_cast<int>(
      std::count_if(all.begin(), all.end(), [](const auto& text) { return text.size_px == kLabelSize; }));
}

/// Finds a rule's label that overlaps a curve, marker, bar, rule, other words or the picture's edge; "" if
/// there is none.
std::string crossed(const std::string& svg, double width, double height) {
  const auto texts = svg_geometry::texts(svg);
  const auto ink = svg_geometry::ink(svg, kAxes);
  for (const auto& label : texts) {
    if (label.size_px != kLabelSize) continue;
    const auto& box = label.box;
    if (box.left < 0 || box.top < 0 || box.right > width || box.bottom > height)
      return label.words + " (out)";
    for (const auto& drawn : ink)
      if (svg_geometry::meet(drawn, box)) return label.words + " (ink)";
    for (const auto& other : texts)
      if (&other != &label && svg_geometry::meet(other.box, box)) return label.words + " on " + other.words;
  }
  return "";
}

Figure with(Chart chart, double width_px, double height_px) {
  Figure figure;
  figure.title = "Labels";
  figure.charts.push_back(std::move(chart));
  figure.chart_width_px = width_px, figure.chart_height_px = height_px;
  return figure;
}

Rule vertical(double at, std::string label) { return {Rule::Direction::vertical, at, std::move(label)}; }
Rule horizontal(double at, std::string label) { return {Rule::Direction::horizontal, at, std::move(label)}; }

Chart empty_panel() {
  Chart chart;
  chart.title = "Drive, and a tone's quality";
  chart.x = {"Frequency (kHz)", 15, 45};
  chart.y = {"Drive edge (\u00b5m)", 0, 0.72};
  return chart;
}

}  // namespace

TEST_CASE("The label of a rule never overlaps a tone's mark, however close they are", "[plot][labels]") {
  const double height = GENERATE(165.0, 200.0, 260.0), width = GENERATE(200.0, 430.0);
  for (double tone = 15; tone <= 45; tone += 2.5)
    for (double off = -4; off <= 4; off += 0.25) {
      if (tone + off < 15 || tone + off > 45) continue;
      auto chart = empty_panel();
      chart.layers.push_back(vertical(tone + off, "resonance"));
      chart.layers.push_back(Points{{tone}, {0.6}, {0}, {0.6}, {}, {}, 0, ""});
      const auto svg = render(with(chart, width, height));
      CAPTURE(width, height, tone, off);
      REQUIRE(labels_on(svg) == 1);
      REQUIRE(crossed(svg, width, height).empty());
    }
}

TEST_CASE("If curves leave no free place, a rule's label is placed outside the data", "[plot][labels]") {
  Line dense;
  for (int i = 0; i <= 3000; ++i) {
    dense.x.push_back(15 + 0.01 * i);
    dense.y.push_back(0.36 + 0.36 * std::sin(2.0 * i));
  }
  auto chart = empty_panel();
  const int rules = GENERATE(1, 2, 3);
  const char* names[] = {"resonance", "edge of the zone", "level"};
  for (int i = 0; i < rules; ++i) chart.layers.push_back(vertical(29 + 0.5 * i, names[i]));
  SECTION("vertical rules, above it, in rows") {}
  SECTION("and a horizontal one, to the right") { chart.layers.push_back(horizontal(0.3, "chance")); }
  SECTION("and two horizontal ones, close together") {
    chart.layers.push_back(horizontal(0.3, "chance"));
    chart.layers.push_back(horizontal(0.31, "mean"));
  }
  chart.layers.push_back(dense);
  const auto svg = render(with(chart, 430, 260));
  CHECK(labels_on(svg) >= rules);
  CHECK(crossed(svg, 430, 260).empty());
}

TEST_CASE("Labels of several rules keep apart from each other, from curves, bars and error bars",
          "[plot][labels]") {
  auto chart = empty_panel();
  chart.y = {"Proportion", 0.4, 1};
  for (const double at : {20.0, 20.4, 44.0}) chart.layers.push_back(vertical(at, "truth 3.14"));
  chart.layers.push_back(horizontal(0.5, "chance"));
  chart.layers.push_back(horizontal(GENERATE(0.52, 0.9, 1.0), "deadline"));
  Points dots{{20, 25, 30, 35, 40},
              {0.5, 0.6, 0.7, 0.9, 0.98},
              {0.4, 0.5, 0.6, 0.8, 0.9},
              {0.6, 0.7, 0.8, 1, 1},
              {5, 10, 20, 10, 5},
              {},
              1,
              "data"};
  chart.layers.push_back(Line{dots.x, dots.y, 0, "fit"});
  chart.layers.push_back(dots);
  chart.layers.push_back(Histogram{{22, 24, 26}, {0.6, 0.8}, 2, ""});
  const auto svg = render(with(chart, 430, 260));
  CHECK(labels_on(svg) == 5);
  CHECK(crossed(svg, 430, 260).empty());
}

TEST_CASE("A free label is at the upper right of its rule, and a rule beyond the axes shows nothing",
          "[plot][labels]") {
  auto chart = empty_panel();
  chart.layers.push_back(vertical(20, "here"));
  chart.layers.push_back(vertical(60, "beyond"));
  const auto svg = render(with(chart, 430, 260));
  REQUIRE(labels_on(svg) == 1);
  const auto rules = svg_geometry::elements(svg, "line");
  const auto dashed = std::find_if(rules.begin(), rules.end(), [](const auto& line) {
    return !svg_geometry::attribute(line, "stroke-dasharray").empty();
  });
  REQUIRE(dashed != rules.end());
  for (const auto& text : svg_geometry::texts(svg))
    if (text.words == "here") {
      CHECK(text.box.left == Approx(svg_geometry::number(*dashed, "x1") + 4));
      // as near to the end of its rule as lines of the grid leave room
      CHECK(text.box.top < svg_geometry::number(*dashed, "y2") + 14);
    }
}

TEST_CASE("Panels of a figure keep equal heights even if only one of them has no place for a label",
          "[plot][labels]") {
  auto tall = empty_panel(), flat = empty_panel();
  tall.layers = {Histogram{{15, 25, 35, 45}, {0.7, 0.7, 0.7}, 0, ""}, vertical(30, "median 1.02 s")};
  flat.layers = {Histogram{{15, 25, 35, 45}, {0.1, 0.1, 0.1}, 0, ""}, vertical(30, "median 1.02 s")};
  auto figure = with(tall, 430, 200);
  figure.charts.push_back(flat);
  figure.columns = 2;
  const auto heights = [](const std::string& svg) {
    std::vector<double> found;
    for (const auto& line : svg_geometry::elements(svg, "line"))
      if (!svg_geometry::attribute(line, "stroke-dasharray").empty())
        found.push_back(svg_geometry::number(line, "y1") - svg_geometry::number(line, "y2"));
    return found;
  };
  const auto together = heights(render(figure));
  REQUIRE(together.size() == 2);
  CHECK(together[0] == together[1]);
  CHECK(crossed(render(figure), 860, 200).empty());
  // Negative control: if the second chart is drawn alone, its label is among the data, and the chart is
  // higher.
  CHECK(heights(render(with(flat, 430, 200)))[0] > together[1]);
}

TEST_CASE("Numbers beside an axis stand a line and a half apart, however low the chart is", "[plot]") {
  for (const double height : {170.0, 200.0, 300.0}) {
    auto chart = empty_panel();
    chart.y = {"Trials", 0, 151};
    chart.layers = {Line{{15, 45}, {0, 140}, 0, "named"}, vertical(30, "median")};
    std::vector<double> lines;
    const auto svg = render(with(chart, 430, height));
    for (const auto& line : svg_geometry::elements(svg, "line"))
      if (svg_geometry::attribute(line, "stroke") == "#e6e6e6")
        lines.push_back(svg_geometry::number(line, "y1"));
    REQUIRE(lines.size() >= 2);
    CHECK(lines[0] - lines[1] >= 18);
  }
}

TEST_CASE("The check of labels detects a label on a marker, on a curve, on words", "[plot][labels]") {
  Svg svg;
  svg.begin(200, 100, "Control");
  svg.text({50, 50}, "resonance", kLabelSize, Anchor::start, "#666666", 400, 0);
  CHECK(crossed(svg.finish(), 200, 100).empty());
  SECTION("marker") { svg.circle({60, 46}, 3, {"#0072b2", "", 1, "", 1}); }
  SECTION("curve") { svg.polyline({{40, 40}, {120, 60}}, {"#0072b2", "", 2, "", 1}); }
  SECTION("words") { svg.text({90, 52}, "Drive", 12, Anchor::start, "#222222", 400, 0); }
  SECTION("edge") { svg.text({180, 50}, "outside", kLabelSize, Anchor::start, "#666666", 400, 0); }
  CHECK_FALSE(crossed(svg.finish(), 200, 100).empty());
}
