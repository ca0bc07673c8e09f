#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "station/report/chart.hpp"
#include "station/report/figure_files.hpp"
#include "station/report/palette.hpp"
#include "station/report/pdf.hpp"
#include "station/report/svg.hpp"
#include "station/system/fonts.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/svg_geometry.hpp"

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

TEST_CASE(
    "A figure that is scrolled keeps its text's size: charts stand below each other, and the caption below "
    "them",
    "[plot]") {
  auto figure = example();
  figure.charts.resize(3, figure.charts[0]);
  figure.caption = "Bars show what nineteen of twenty repetitions would lie between.";
  for (int i = 0; i < 3; ++i) figure.caption += " " + figure.caption;
  // the same charts in a figure that is not scrolled: the document is wider than the view, and is scaled down
  // to it
  CHECK(size_px(laid_out(figure, 360, 200)).first > 500);
  const auto scrolled = laid_out_to_scroll(figure, 360, 200);
  CHECK(scrolled.columns == 1);
  CHECK(size_px(scrolled).first == 360);
  CHECK(scrolled.chart_height_px == 200);
  CHECK(scrolled.caption == figure.caption);
  CHECK(size_px(scrolled).second == 3 * 200 + caption_height_px(scrolled));
  CHECK_NOTHROW(render(scrolled));
  // in a large view all of it is seen at once
  figure.caption = "Bars show intervals.";
  const auto large = laid_out_to_scroll(figure, 1200, 500);
  CHECK(large.columns == 2);
  CHECK(size_px(large) == Point(1200, 500));
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

namespace {

Chart two_conditions(double second_low, double second_high) {
  Chart chart;
  chart.x = {"Level", 0, 4};
  chart.y = {"Proportion", 0, 1};
  chart.layers = {Points{{1, 2, 3}, {0.3, 0.5, 0.7}, {0.2, 0.4, 0.6}, {0.4, 0.6, 0.8}, {}, {}, 0, "a"},
                  Points{{1, 2, 3},
                         {second_low, second_low, second_low},
                         {second_low, second_low, second_low},
                         {second_high, second_high, second_high},
                         {},
                         {},
                         1,
                         "b"}};
  return chart;
}

Figure one_chart(Chart chart) {
  Figure figure;
  figure.title = "One";
  figure.charts = {std::move(chart)};
  return figure;
}

/// The positions of the vertical lines in the colour of a series.
std::vector<double> bars_of(const std::string& svg, int series) {
  std::vector<double> places;
  for (const auto& line : svg_geometry::elements(svg, "line"))
    if (svg_geometry::attribute(line, "stroke") == style(series).colour &&
        svg_geometry::number(line, "x1") == svg_geometry::number(line, "x2"))
      places.push_back(svg_geometry::number(line, "x1"));
  return places;
}

std::size_t arrows(const std::string& svg) { return svg_geometry::elements(svg, "polygon").size(); }

}  // namespace

TEST_CASE("Intervals of two conditions at one level stand beside each other, and only then", "[plot]") {
  const auto overlapping = render(one_chart(two_conditions(0.3, 0.7)));
  const auto first = bars_of(overlapping, 0), second = bars_of(overlapping, 1);
  REQUIRE(first.size() == 3);
  REQUIRE(second.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(second[i] - first[i] > 5);
    CHECK(second[i] - first[i] < 12);
  }
  const auto apart = render(one_chart(two_conditions(0.85, 0.95)));
  CHECK(bars_of(apart, 0) == bars_of(apart, 1));
  auto in_place = two_conditions(0.3, 0.7);
  in_place.beside = false;
  const auto kept = render(one_chart(in_place));
  CHECK(bars_of(kept, 0) == bars_of(kept, 1));
}

TEST_CASE("Intervals beside each other stay nearer to their level than to the next", "[plot]") {
  Chart chart;
  chart.x = {"Level", 0, 60};
  chart.y = {"Proportion", 0, 1};
  for (int series = 0; series < 4; ++series)
    chart.layers.push_back(
        Points{{30, 31}, {0.5, 0.5}, {0.3, 0.3}, {0.7, 0.7}, {}, {}, series, std::to_string(series)});
  const auto svg = render(one_chart(chart));
  const auto first = bars_of(svg, 0), last = bars_of(svg, 3);
  REQUIRE((first.size() == 2 && last.size() == 2));
  CHECK(last[0] > first[0]);
  CHECK(last[0] < first[1]);
}

TEST_CASE("A line through the same points moves with them", "[plot]") {
  auto chart = two_conditions(0.3, 0.7);
  chart.layers.push_back(Line{{1, 2, 3}, {0.3, 0.5, 0.7}, 0, ""});
  const auto svg = render(one_chart(chart));
  const auto lines = svg_geometry::elements(svg, "polyline");
  REQUIRE(lines.size() == 1);
  CHECK(std::stod(svg_geometry::attribute(lines[0], "points")) == Approx(bars_of(svg, 0)[0]).margin(0.02));
}

TEST_CASE("Horizontal intervals at one height stand above each other", "[plot]") {
  Chart chart;
  chart.x = {"Level", 0, 4};
  chart.y = {"Proportion", 0, 1};
  chart.layers = {Span{1, 2, 0.5, 0}, Span{1.5, 3, 0.5, 1}};
  const auto height = [&](int series) {
    for (const auto& line : svg_geometry::elements(render(one_chart(chart)), "line"))
      if (svg_geometry::attribute(line, "stroke") == style(series).colour &&
          svg_geometry::number(line, "y1") == svg_geometry::number(line, "y2"))
        return svg_geometry::number(line, "y1");
    return 0.0;
  };
  CHECK(std::abs(height(0) - height(1)) > 5);
  chart.layers = {Span{1, 2, 0.5, 0}, Span{2.5, 3, 0.5, 1}};
  CHECK(height(0) == height(1));
}

TEST_CASE("Where an axis cuts an interval, an arrow says so", "[plot]") {
  Chart chart;
  chart.x = {"Level", 1, 3};
  chart.y = {"Proportion", 0, 1};
  const auto drawn = [&](Layer layer) {
    chart.layers = {std::move(layer)};
    return arrows(render(one_chart(chart)));
  };
  const auto bar = [](double low, double high) { return Points{{2}, {0.5}, {low}, {high}, {}, {}, 0, ""}; };
  CHECK(drawn(bar(0.2, 0.8)) == 0);
  CHECK(drawn(bar(0, 1)) == 0);
  CHECK(drawn(bar(-0.1, 0.8)) == 1);
  CHECK(drawn(bar(-0.1, 1.1)) == 2);
  CHECK(drawn(bar(0.2, INFINITY)) == 1);
  CHECK(drawn(Span{1.5, 2, 0.5, 0}) == 0);
  CHECK(drawn(Span{0.5, 2, 0.5, 0}) == 1);
  CHECK(drawn(Span{-INFINITY, INFINITY, 0.5, 0}) == 2);
  CHECK(drawn(Span{3.5, 4, 0.5, 0}) == 0);  // outside the axis altogether
  chart.x.scale = AxisScale::log10;
  CHECK(drawn(Span{-1, 2, 0.5, 0}) == 1);  // a log axis has no place for values below 0
}

TEST_CASE("A legend appears only where there is something to tell apart", "[plot]") {
  auto chart = two_conditions(0.3, 0.7);
  CHECK(render(one_chart(chart)).find(">b</text>") != std::string::npos);
  chart.layers.pop_back();
  CHECK(render(one_chart(chart)).find(">a</text>") == std::string::npos);
}

TEST_CASE("An axis of names shows each of them, turned upright if they are many", "[plot]") {
  for (const std::size_t count : {3U, 40U}) {
    Chart chart;
    chart.y = {"Threshold", 0, 1};
    for (std::size_t i = 0; i < count; ++i) chart.x.names.push_back("P" + std::to_string(100 + i));
    chart.x.label = "Participant", chart.x.low = 0.4, chart.x.high = static_cast<double>(count) + 0.6;
    auto figure = one_chart(chart);
    figure.chart_width_px = 680;
    const auto svg = render(figure);
    for (const auto& name : chart.x.names) CHECK(svg.find(">" + name + "</text>") != std::string::npos);
    CHECK((svg.find("rotate(-90 ") != svg.rfind("rotate(-90 ")) == (count > 3));  // the vertical axis has one
  }
}

TEST_CASE("A log axis always has at least three labels, in one column too", "[plot]") {
  for (const double low : {0.0013, 0.04, 0.3, 0.9, 2.1, 55.0})
    for (double ratio = 1.02; ratio < 1e7; ratio *= 1.17)
      for (const int wanted : {2, 4, 7}) {
        const auto list = ticks({"", low, low * ratio, AxisScale::log10}, wanted);
        CAPTURE(low, ratio, wanted);
        REQUIRE(std::count_if(list.begin(), list.end(),
                              [](const Tick& tick) { return !tick.label.empty(); }) >= 3);
      }
  for (const double ratio : {1.3, 2.0, 4.2, 9.0, 90.0, 1e4}) {
    auto chart = two_conditions(0.3, 0.7);
    chart.x = {"Level", 1.1, 1.1 * ratio, AxisScale::log10};
    const auto svg = render(for_paper(one_chart(chart), kOneColumn_mm));
    std::map<double, int> labels;  // by the height of their baselines
    for (const auto& text : svg_geometry::texts(svg)) ++labels[text.box.top];
    CAPTURE(ratio);
    CHECK(std::any_of(labels.begin(), labels.end(), [](const auto& line) { return line.second >= 3; }));
  }
}

namespace {

/// Charts with the same axes, in each of which two series stand.
Figure panels(int count) {
  Figure figure;
  figure.title = "Panels";
  for (int i = 0; i < count; ++i) {
    figure.charts.push_back(two_conditions(0.3, 0.7));
    figure.charts.back().title = "condition " + std::to_string(i);
  }
  return on_page(figure, 330);
}

}  // namespace

TEST_CASE("Charts with the same axes show their labels and their legend once, and have data of the same size",
          "[plot]") {
  for (const int charts : {2, 3, 4, 5, 6}) {
    const auto figure = for_paper(panels(charts), kTwoColumns_mm);
    const auto svg = render(figure);
    const int rows = (charts + figure.columns - 1) / figure.columns;
    CAPTURE(charts, figure.columns);
    CHECK(count(svg, ">Proportion</text>") == static_cast<std::size_t>(rows));
    CHECK(count(svg, ">Level</text>") == static_cast<std::size_t>(std::min(charts, figure.columns)));
    CHECK(count(svg, ">a</text>") == 1);
    CHECK(count(svg, ">b</text>") == 1);
    // no places are left empty if another arrangement has fewer of them
    CHECK(rows * figure.columns - charts <= (charts == 5 ? 1 : 0));
    std::set<std::pair<double, double>> sizes;
    for (const auto& clip : svg_geometry::elements(svg, "rect"))
      if (svg.find("<clipPath") != std::string::npos && svg_geometry::attribute(clip, "fill").empty())
        sizes.insert({std::round(svg_geometry::number(clip, "width")),
                      std::round(svg_geometry::number(clip, "height"))});
    CHECK(sizes.size() == 1);
  }
  auto figure = panels(3);
  figure.charts[1].y.low = -1;  // another axis: each chart needs its labels
  CHECK(count(render(for_paper(figure, kTwoColumns_mm)), ">Proportion</text>") == 3);
  figure.charts[2].layers.push_back(Points{{2}, {0.5}, {}, {}, {}, {}, 2, "c"});
  CHECK(count(render(figure), ">a</text>") == 1);
  std::get<Points>(figure.charts[1].layers[0]).name = "other";  // another legend
  CHECK(count(render(figure), ">a</text>") == 2);
}

TEST_CASE(
    "In the size of a paper, legends and labels leave half of a chart's width to the height of its data, and "
    "a "
    "page has room for its caption",
    "[plot]") {
  for (const double width_mm : {kOneColumn_mm, kTwoColumns_mm}) {
    for (int series = 1; series <= 6; ++series) {
      auto chart = two_conditions(0.3, 0.7);
      for (int i = 0; i < series; ++i) {
        const auto name = "condition with a long name " + std::to_string(i);
        chart.layers.push_back(Line{{1, 3}, {0.1 * i, 0.9}, i, name});
        chart.layers.push_back(
            Rule{Rule::Direction::vertical, 1.5 + 0.2 * i, name + ": threshold 0.168 (81.6 %)", i});
      }
      const auto figure = for_paper(one_chart(chart), width_mm);
      CAPTURE(width_mm, series);
      CHECK(least_data_px(figure) >= 0.45 * figure.chart_width_px);
    }
    for (int charts = 2; charts <= 6; ++charts)
      CHECK(size_px(for_paper(panels(charts), width_mm)).second <= 200 * 96 / 25.4);
    for (int charts = 7; charts <= 18; ++charts) {
      CAPTURE(width_mm, charts);
      const auto figure = for_paper(panels(charts), width_mm);
      CHECK(size_px(figure).second <= 230 * 96 / 25.4);
      CHECK(least_data_px(figure) >= (charts <= 10 ? 60 : 35));
    }
  }
}

TEST_CASE("A horizontal interval stays on its marker when it is moved", "[plot]") {
  Chart chart;
  chart.x = {"Time", 0, 4};
  chart.y = {"Sensitivity", 0, 2};
  for (const int series : {0, 1}) {
    const double x = 2 + 0.01 * series, y = 1 + 0.01 * series;
    chart.layers.push_back(
        Points{{x}, {y}, {y - 0.5}, {y + 0.5}, {}, {}, series, "c" + std::to_string(series)});
    chart.layers.push_back(Span{x - 1, x + 1, y, series, true});
  }
  const auto svg = render(one_chart(chart));
  std::vector<std::pair<double, double>> crossings;
  for (const int series : {0, 1}) {
    double upright = 0, flat = 0, left = 0, right = 0;
    for (const auto& line : svg_geometry::elements(svg, "line")) {
      if (svg_geometry::attribute(line, "stroke") != style(series).colour) continue;
      const double x1 = svg_geometry::number(line, "x1"), x2 = svg_geometry::number(line, "x2");
      if (x1 == x2 && svg_geometry::attribute(line, "stroke-width") == "1.3") upright = x1;
      if (x1 != x2) flat = svg_geometry::number(line, "y1"), left = x1, right = x2;
    }
    CHECK(upright == Approx((left + right) / 2).margin(0.05));
    crossings.emplace_back(upright, flat);
  }
  CHECK(std::abs(crossings[0].first - crossings[1].first) > 3.5);
  CHECK(std::abs(crossings[0].second - crossings[1].second) > 5);
  const auto circles = svg_geometry::elements(svg, "circle");
  REQUIRE(!circles.empty());
  CHECK(svg_geometry::number(circles.back(), "cy") == Approx(crossings[0].second).margin(0.05));
  CHECK(has_moved(one_chart(chart)));
  chart.layers.resize(2);
  CHECK(!has_moved(one_chart(chart)));
}

TEST_CASE("No marker is drawn above the largest possible value", "[plot]") {
  Chart chart;
  chart.x = {"Time", 0, 4};
  chart.y = {"Proportion", 0.5, 1.03};
  chart.y.most = 1;
  const auto heights = [&chart] {
    std::vector<double> flat;
    for (const auto& line : svg_geometry::elements(render(one_chart(chart)), "line"))
      for (const int series : {0, 1})
        if (svg_geometry::attribute(line, "stroke") == style(series).colour &&
            svg_geometry::number(line, "x1") + 50 < svg_geometry::number(line, "x2"))
          flat.push_back(svg_geometry::number(line, "y1"));
    return flat;
  };
  const auto place = [&chart](double first, double second) {
    chart.layers.clear();
    for (const int series : {0, 1}) {
      const double x = series == 0 ? first : second;
      chart.layers.push_back(Points{{x}, {1}, {0.9}, {1}, {}, {}, series, "c" + std::to_string(series)});
      chart.layers.push_back(Span{x - 0.5, x + 0.5, 1, series, true});
    }
  };
  place(1, 3);
  REQUIRE(heights().size() == 2);
  CHECK(!has_moved(one_chart(chart)));
  const double at_one = heights()[0];
  place(2, 2);
  REQUIRE(heights().size() == 2);
  CHECK(has_moved(one_chart(chart)));
  for (const double height : heights()) CHECK(height >= at_one - 0.01);
}

TEST_CASE("A marker stays where it is when the interval of a threshold at its height is moved", "[plot]") {
  auto chart = two_conditions(0.3, 0.7);
  const auto middle = [&chart](int series) {
    const auto circles = svg_geometry::elements(render(one_chart(chart)), "circle");
    std::vector<double> heights;
    for (const auto& circle : circles)
      if (svg_geometry::attribute(circle, "fill") == style(series).colour)
        heights.push_back(svg_geometry::number(circle, "cy"));
    return heights;
  };
  const auto before = middle(0);
  REQUIRE(!before.empty());
  for (const int series : {0, 1}) chart.layers.push_back(Span{1.5, 2.5, 0.5, series});
  CHECK(middle(0) == before);
}

TEST_CASE(
    "A rule ends at the height that it says, in the colour of its series, and labels above keep their order",
    "[plot]") {
  Chart chart;
  chart.x = {"Level", 0, 4};
  chart.y = {"Proportion", 0, 1};
  chart.layers = {Line{{0, 4}, {0.5, 0.5}, 0, "", false, true},
                  Rule{Rule::Direction::vertical, 2, "first", 1, 0.5}};
  auto svg = render(one_chart(chart));
  const auto beyond = svg_geometry::elements(svg, "polyline").at(0);
  CHECK(svg_geometry::attribute(beyond, "stroke-dasharray") == "3 3");
  CHECK(svg_geometry::number(beyond, "stroke-width") == 1);
  double x = 0, y = 0;
  char comma = 0;
  std::istringstream(svg_geometry::attribute(beyond, "points")) >> x >> comma >> y;
  const auto lines = svg_geometry::elements(svg, "line");
  const auto rule = std::find_if(lines.begin(), lines.end(), [](const auto& line) {
    return !svg_geometry::attribute(line, "stroke-dasharray").empty();
  });
  REQUIRE(rule != lines.end());
  CHECK(svg_geometry::number(*rule, "y2") == Approx(y).margin(0.02));
  CHECK(svg_geometry::attribute(*rule, "stroke") == style(1).colour);
  for (const auto& text : svg_geometry::texts(svg))
    if (text.words == "first") {
      CHECK(text.box.top > y);
      CHECK(text.colour == style(1).colour);
    }
  Line dense;
  for (int i = 0; i <= 3000; ++i)
    dense.x.push_back(4.0 * i / 3000), dense.y.push_back(0.5 + 0.5 * std::sin(2.0 * i));
  chart.layers = {dense, Rule{Rule::Direction::vertical, 1, "first"},
                  Rule{Rule::Direction::vertical, 2, "second"}, Rule{Rule::Direction::vertical, 3, "third"}};
  svg = render(one_chart(chart));
  std::map<std::string, double> heights;
  for (const auto& text : svg_geometry::texts(svg)) heights[text.words] = text.box.top;
  CHECK(heights["first"] < heights["second"]);
  CHECK(heights["second"] < heights["third"]);
}

namespace {

/// The texts of a PDF, as a reader selects them, each between two strokes: its codes by the first font's
/// table.
std::string selected(const std::string& pdf) {
  std::map<std::string, char> meanings;
  for (auto at = pdf.find("beginbfchar <"); at != std::string::npos; at = pdf.find("beginbfchar <", at + 1))
    meanings[pdf.substr(at + 13, 2)] = static_cast<char>(std::stoi(pdf.substr(at + 18, 4), nullptr, 16));
  std::string all = "|";
  for (auto at = pdf.find(" Tf <"); at != std::string::npos; at = pdf.find(" Tf <", at + 1)) {
    const auto codes = pdf.substr(at + 5, pdf.find('>', at) - at - 5);
    for (std::size_t i = 0; i < codes.size(); i += 2) all += meanings[codes.substr(i, 2)];
    all += "|";
  }
  return all;
}

}  // namespace

TEST_CASE("The files of a figure are as wide as one and two columns, and have its data and caption",
          "[plot]") {
  auto figure = example();
  figure.caption = "Participant P01, 70 trials.";
  const NamedFigure named{"example", figure};
  const auto square = [](char32_t, bool) { return Outline{0.5, "0 0 m 0.4 0 l 0.4 0.7 l h "}; };
  const auto pdf_of = [&](const Figure& drawn) {
    Pdf pdf(square);
    draw(pdf, drawn);
    return pdf.finish();
  };
  std::map<std::string, std::string> files;
  for (const auto& file : figure_files(named, pdf_of)) files[file.name] = file.bytes;
  CHECK(files.size() == 6);
  CHECK(files["example-1-column.svg"].find("width=\"85mm\"") != std::string::npos);
  CHECK(files["example-2-columns.svg"].find("width=\"180mm\"") != std::string::npos);
  CHECK(files["example-1-column.svg"].find("70 trials") == std::string::npos);
  CHECK(files["example.txt"] == "Example <1>. Participant P01, 70 trials.\n");
  const auto& csv = files["example.csv"];
  CHECK(csv.find("A & B,Level (dB),Proportion,marker,data,-20,,,0.7,0.6,0.8,20,\n") != std::string::npos);
  CHECK(csv.find("A & B,Level (dB),Proportion,band,,-10,,,,0.9,1,,\n") != std::string::npos);
  CHECK(csv.find("nan") == std::string::npos);
  for (const char* name : {"example-1-column.pdf", "example-2-columns.pdf"}) {
    const auto& pdf = files[name];
    CHECK(pdf == pdf_of(for_paper(figure, std::string(name) == "example-1-column.pdf" ? 85 : 180)));
    CHECK(pdf.find("/FontFile3") != std::string::npos);
    CHECK(selected(pdf).find("|A & B|") != std::string::npos);
    CHECK(selected(pdf).find("|Proportion|") != std::string::npos);
    // each entry of the table of objects points to its object
    const auto table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
    REQUIRE(pdf.compare(table, 5, "xref\n") == 0);
    std::istringstream lines(pdf.substr(pdf.find("0000000000 65535 f \n", table) + 20));
    std::string line;
    int objects = 0;
    while (std::getline(lines, line) && line.ends_with(" n ")) {
      const auto start = std::to_string(++objects) + " 0 obj\n";
      CHECK(pdf.compare(std::stoul(line), start.size(), start) == 0);
    }
    CHECK(objects == 9);  // one font
  }
}

namespace {

/// The fonts that a PDF embeds.
std::vector<std::string> fonts_of(const std::string& pdf) {
  const std::string entry = "/Subtype/Type1C/Length ";
  std::vector<std::string> fonts;
  for (auto at = pdf.find(entry); at != std::string::npos; at = pdf.find(entry, at + 1)) {
    const auto start = pdf.find("stream\n", at) + 7;
    fonts.push_back(pdf.substr(start, std::stoul(pdf.substr(at + entry.size()))));
  }
  return fonts;
}

/// How many closed curves a path has, and the box of its points in thousandths of the font's size.
struct Shape {
  int curves = 0;
  long left = 0, right = 0, bottom = 0, top = 0;
  bool operator==(const Shape&) const = default;
};

Shape shape_of(const std::string& path) {
  Shape shape;
  std::vector<long> coordinates[2];
  std::size_t of = 0;
  std::istringstream words(path);
  for (std::string word; words >> word;) {
    if (word == "m") ++shape.curves;
    if (std::isalpha(static_cast<unsigned char>(word[0])) == 0)
      coordinates[of++ % 2].push_back(std::lround(1000 * std::stod(word)));
  }
  if (shape.curves == 0) return shape;
  const auto [left, right] = std::ranges::minmax(coordinates[0]);
  const auto [bottom, top] = std::ranges::minmax(coordinates[1]);
  return {shape.curves, left, right, bottom, top};
}

}  // namespace

TEST_CASE("FreeType reads the letters of a PDF's fonts, each with its width and shape", "[plot]") {
  std::u32string letters;
  std::string text;
  for (char32_t c = U'!'; c < 0x250; ++c) {
    if (c >= 0x7F && c <= 0xA0) continue;
    letters += c;
    if (c < 0x80)
      text += static_cast<char>(c);
    else
      (text += static_cast<char>(0xC0 | (c >> 6U))) += static_cast<char>(0x80 | (c & 63U));
  }
  Pdf pdf(turnpoint::system::outline);
  pdf.begin(100, 100, "letters");
  pdf.text({0, 50}, text, 10, Anchor::start, "#000000", 400, 0);
  const auto fonts = fonts_of(pdf.finish());
  REQUIRE(fonts.size() == 3);
  FT_Library library = nullptr;
  REQUIRE(FT_Init_FreeType(&library) == 0);
  std::size_t at = 0;
  for (const auto& font : fonts) {
    FT_Face face = nullptr;
    REQUIRE(FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(font.data()),
                               static_cast<FT_Long>(font.size()), 0, &face) == 0);
    CHECK(face->units_per_EM == 1000);
    REQUIRE(FT_Select_Charmap(face, FT_ENCODING_ADOBE_CUSTOM) == 0);
    for (FT_ULong code = 1; code <= 255 && at < letters.size(); ++code, ++at) {
      CAPTURE(code, static_cast<unsigned>(letters[at]));
      REQUIRE(FT_Load_Char(face, code, FT_LOAD_NO_SCALE) == 0);
      const auto [advance, path] = turnpoint::system::outline(letters[at], false);
      CHECK(face->glyph->metrics.horiAdvance == std::lround(1000 * advance));
      FT_BBox box;
      FT_Outline_Get_CBox(&face->glyph->outline, &box);
      CHECK(Shape{face->glyph->outline.n_contours, box.xMin, box.xMax, box.yMin, box.yMax} == shape_of(path));
    }
    FT_Done_Face(face);
  }
  FT_Done_FreeType(library);
  CHECK(at == letters.size());
}

TEST_CASE("A PDF refuses letters that it would draw in a wrong shape", "[plot]") {
  auto figure = example();
  figure.charts[0].title = "\u0639\u0631\u0628\u064a";
  Pdf pdf([](char32_t, bool) { return Outline{0.5, ""}; });
  CHECK_THROWS_AS(draw(pdf, figure), JoinedLetters);
}
