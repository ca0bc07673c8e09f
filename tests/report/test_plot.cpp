#include <cmath>
#include <set>
#include <utility>

#include "station/report/chart.hpp"
#include "station/report/palette.hpp"
#include "station/report/svg.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::report;

namespace {

Figure example() {
  Figure figure;
  figure.title = "Example <1>";
  Chart chart{
      "A & B", {"Level (dB)", -32, -8, AxisScale::linear}, {"Proportion", 0.4, 1, AxisScale::linear}, {}};
  chart.layers.push_back(Band{{-30, -20, -10}, {0.45, 0.6, 0.9}, {0.6, 0.8, 1}, 0, ""});
  chart.layers.push_back(Rule{Rule::Direction::horizontal, 0.5, "chance"});
  chart.layers.push_back(Line{{-30, -20, NAN, -15, -10}, {0.5, 0.7, 0.8, 0.8, 0.95}, 0, "fit"});
  chart.layers.push_back(
      Points{{-30, -20, -10}, {0.5, 0.7, 0.95}, {0.4, 0.6, 0.9}, {0.6, 0.8, 1}, {10, 20, 40}, {}, 1, "data"});
  figure.charts = {chart};
  return figure;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("Ticks are 1, 2 or 5 times a power of ten, inside the axis, with a typographic minus sign",
          "[plot]") {
  std::vector<std::string> labels;
  for (const auto& tick : ticks({"", -30, -10, AxisScale::linear}, 5)) labels.push_back(tick.label);
  CHECK(labels == std::vector<std::string>{"\u221230", "\u221225", "\u221220", "\u221215", "\u221210"});
  for (const double high : {0.003, 0.7, 1.0, 13.0, 9e4})
    for (const int wanted : {3, 6, 10}) {
      const auto list = ticks({"", 0, high, AxisScale::linear}, wanted);
      CHECK(list.size() >= 2);
      CHECK(static_cast<int>(list.size()) <= 2 * wanted + 1);
      CHECK(list.front().value == 0);
      CHECK(list.back().value <= high * (1 + 1e-9));
    }
}

TEST_CASE("An axis of counts has ticks at whole numbers only", "[plot]") {
  for (const double high : {1.1, 1.9, 4.5, 12.0})
    for (const auto& tick : ticks({"", 0, high, AxisScale::linear, true}, 8))
      CHECK(tick.value == std::round(tick.value));
  // axes that are not for whole numbers have finer ticks
  CHECK(ticks({"", 0, 1.1, AxisScale::linear}, 8)[1].value < 1);
}

TEST_CASE("A chart's title stays within the chart, whatever its length", "[plot]") {
  struct Titles : Canvas {
    const std::string wanted;
    double left = 0, right = 0;
    explicit Titles(std::string title) : wanted(std::move(title)) {}
    void begin(double, double, const std::string&) override {}
    void line(Point, Point, const Paint&) override {}
    void polyline(const std::vector<Point>&, const Paint&) override {}
    void polygon(const std::vector<Point>&, const Paint&) override {}
    void rectangle(Point, double, double, const Paint&) override {}
    void circle(Point, double, const Paint&) override {}
    void begin_clip(Point, double, double) override {}
    void end_clip() override {}
    void text(Point at, const std::string& text, double size, Anchor, const std::string&, int,
              double) override {
      if (text == wanted) left = at.first, right = at.first + text_width(text, size);
    }
  };
  for (const int letters : {5, 30, 60, 200}) {
    auto figure = example();
    figure.charts[0].title = std::string(static_cast<std::size_t>(letters), 'x');
    Titles titles(figure.charts[0].title);
    draw(titles, figure);
    CHECK(titles.left > 0);
    CHECK(titles.right > titles.left);
    CHECK(titles.right <= figure.chart_width_px + 1e-6);
  }
}

TEST_CASE("A log axis has ticks in each decade and equal ratios equal lengths", "[plot]") {
  const Axis axis{"", 1, 100, AxisScale::log10};
  std::vector<double> values;
  for (const auto& tick : ticks(axis, 7)) values.push_back(tick.value);
  CHECK(values == std::vector<double>{1, 2, 5, 10, 20, 50, 100});
  CHECK(position(axis, 10) == Approx(0.5));
  CHECK(ticks({"", 1e-6, 1e6, AxisScale::log10}, 6).size() == 13);
}

TEST_CASE("Axes without a range, or a log axis from 0, are refused", "[plot]") {
  CHECK_THROWS_AS(ticks({"", 1, 1, AxisScale::linear}), std::invalid_argument);
  CHECK_THROWS_AS(ticks({"", 0, 1, AxisScale::log10}), std::invalid_argument);
  CHECK_THROWS_AS(ticks({"", 0, NAN, AxisScale::linear}), std::invalid_argument);
  CHECK_THROWS_AS(ticks({"", 0.5, 0.5 + 1e-15, AxisScale::linear}), std::invalid_argument);
  // two values that differ only by rounding, such as means of equal response times
  CHECK(ticks(fitted("", {0.54, 0.54 + 2e-16})).size() < 12);
  const auto lonely = fitted("", {3}), empty = fitted("", {}), wide = fitted("", {0, NAN, 10}, 0.1);
  CHECK(lonely.low < 3);
  CHECK(lonely.high > 3);
  CHECK(empty.low < empty.high);
  CHECK(wide.low == Approx(-1));
  CHECK(wide.high == Approx(11));
}

TEST_CASE("A figure always has the same bytes, is escaped, and contains no NaN", "[plot]") {
  const auto svg = render(example());
  CHECK(svg == render(example()));
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("A &amp; B") != std::string::npos);
  CHECK(svg.find("Example &lt;1&gt;") != std::string::npos);
  CHECK(count(svg, "<polyline") == 2);  // values that are not finite interrupt the curve
  CHECK(count(svg, "<svg") == 1);
  CHECK(count(svg, "<g ") == count(svg, "</g>"));
}

TEST_CASE("Each series has its own colour and marker, and each line its own dash", "[plot]") {
  std::set<std::string> colours, dashes;
  std::set<int> markers;
  for (int i = 0; i < 6; ++i) {
    colours.insert(style(i).colour);
    dashes.insert(style(i).dash);
    markers.insert(static_cast<int>(style(i).marker));
  }
  CHECK(colours.size() == 6);
  CHECK(dashes.size() == 6);
  CHECK(markers.size() == 6);
  CHECK(style(6).colour == style(0).colour);
}

TEST_CASE("A figure laid out for a given size fills it, in the arrangement that suits its charts", "[plot]") {
  Figure figure;
  figure.title = "Two";
  Chart chart;
  chart.x = {"x", 0, 1};
  chart.y = {"y", 0, 1};
  chart.layers.push_back(Line{{0, 1}, {0, 1}, 0, ""});
  figure.charts = {chart, chart};
  const auto wide = laid_out(figure, 640, 200);
  CHECK(wide.columns == 2);
  CHECK(wide.chart_width_px == 320);
  CHECK(wide.chart_height_px == 200);
  const auto high = laid_out(figure, 400, 540);
  CHECK(high.columns == 1);
  CHECK(high.chart_width_px == 400);
  CHECK(high.chart_height_px == 270);
  // The figure still fits with a caption below it.
  figure.caption = "Bars show what nineteen of twenty repetitions would lie between.";
  const auto told = laid_out(figure, 640, 240);
  CHECK(told.chart_height_px < 240);
  CHECK(render(told).find("height=\"240\"") != std::string::npos);
  // If there is not enough room, the document grows and the text keeps its size.
  figure.caption.clear();
  const auto tiny = laid_out(figure, 100, 40);
  CHECK(tiny.chart_height_px >= 165);
  CHECK_NOTHROW(render(tiny));
}

TEST_CASE("Lists whose lengths differ are refused", "[plot]") {
  auto figure = example();
  figure.charts[0].layers = {Line{{1, 2}, {1}, 0, ""}};
  CHECK_THROWS_AS(render(figure), std::invalid_argument);
  figure.charts[0].layers = {Points{{1}, {1}, {0.5, 0.6}, {0.5, 0.6}, {}, {}, 0, ""}};
  CHECK_THROWS_AS(render(figure), std::invalid_argument);
  figure.charts[0].layers = {HeatMap{{0, 1}, {0, 1, 2}, {0.5}, 0, 1, ""}};
  CHECK_THROWS_AS(render(figure), std::invalid_argument);
  figure.charts.clear();
  CHECK_THROWS_AS(render(figure), std::invalid_argument);
}

TEST_CASE("A histogram counts every value in range once", "[plot]") {
  const auto bars = histogram({0, 0.1, 0.5, 0.99, 1, 2, NAN}, 0, 1, 4);
  CHECK(bars.heights == std::vector<double>{2, 0, 1, 2});
  CHECK(bars.edges.size() == 5);
}

TEST_CASE("The estimated width of a text is never too small, and wide characters count as one em", "[plot]") {
  CHECK(text_width("abc", 10) == Approx(18.6));
  CHECK(text_width("\u5de6\u53f3", 10) == Approx(20));
  CHECK(text_width("\u2212", 10) == Approx(6.2));
}
