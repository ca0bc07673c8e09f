#include "station/ui/operator/painter_canvas.hpp"

#include <QGuiApplication>
#include <QImage>
#include <cmath>

#include "station/report/chart.hpp"
#include "tests/support/catch.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;

namespace {

constexpr QRgb kPaper = qRgb(255, 255, 255);

/// Returns the picture that `draw` paints into the middle of a sheet of 400 x 300 pixels.
template <class Draw>
QImage painted(Draw draw) {
  QImage sheet(400, 300, QImage::Format_RGB32);
  sheet.fill(kPaper);
  QPainter painter(&sheet);
  ui::PainterCanvas canvas(painter, QRectF(0, 0, 400, 300));
  draw(canvas);
  return sheet;
}

/// Returns the smallest rectangle that contains all pixels that are not white paper.
QRect inked(const QImage& sheet) {
  QRect all;
  for (int y = 0; y < sheet.height(); ++y)
    for (int x = 0; x < sheet.width(); ++x)
      if (sheet.pixel(x, y) != kPaper) all |= QRect(x, y, 1, 1);
  return all;
}

/// An application object without a screen, because fonts need one.
struct Screen {
  bool offscreen = qputenv("QT_QPA_PLATFORM", "offscreen");
  EventLoop<QGuiApplication> loop;
};

const report::Paint kBlack{"", "#000000", 1, "", 1};

}  // namespace

TEST_CASE("a figure is painted in the middle, as large as its proportions allow", "[ui]") {
  const auto sheet = painted([](report::Canvas& canvas) {
    canvas.begin(100, 100, "square");
    canvas.rectangle({0, 0}, 100, 100, kBlack);
  });
  CHECK(inked(sheet) == QRect(50, 0, 300, 300));
}

TEST_CASE("shapes outside a clip are not painted, and shapes after the clip ends are", "[ui]") {
  const auto clipped = painted([](report::Canvas& canvas) {
    canvas.begin(400, 300, "clip");
    canvas.begin_clip({100, 100}, 50, 60);
    canvas.line({0, 0}, {400, 300}, {"#000000", "", 4, "", 1});
    canvas.rectangle({0, 0}, 400, 300, kBlack);
    canvas.end_clip();
  });
  CHECK(inked(clipped) == QRect(100, 100, 50, 60));
  const auto after = painted([](report::Canvas& canvas) {
    canvas.begin(400, 300, "clip");
    canvas.begin_clip({100, 100}, 50, 60);
    canvas.end_clip();
    canvas.rectangle({0, 0}, 20, 30, kBlack);
  });
  CHECK(inked(after) == QRect(0, 0, 20, 30));
}

TEST_CASE("the length of dashes does not depend on the width of the line", "[ui]") {
  for (const double width : {2.0, 6.0}) {
    const auto sheet = painted([&](report::Canvas& canvas) {
      canvas.begin(400, 300, "dashes");
      canvas.line({0, 150}, {400, 150}, {"#000000", "", width, "40 60", 1});
    });
    int dark = 0;
    for (int x = 0; x < 400; ++x) dark += qGray(sheet.pixel(x, 150)) < 128 ? 1 : 0;
    CHECK(std::abs(dark - 160) <= 8);
  }
}

TEST_CASE("text is aligned at its start, middle or end, and rotates counter-clockwise", "[ui]") {
  const Screen screen;
  const auto at = [](report::Anchor anchor, double degrees) {
    return inked(painted([&](report::Canvas& canvas) {
      canvas.begin(400, 300, "text");
      canvas.text({200, 150}, "HHHH", 24, anchor, "#000000", 400, degrees);
    }));
  };
  CHECK(std::abs(at(report::Anchor::start, 0).left() - 200) <= 4);
  CHECK(std::abs(at(report::Anchor::middle, 0).center().x() - 200) <= 4);
  CHECK(std::abs(at(report::Anchor::end, 0).right() - 200) <= 4);
  CHECK(std::abs(at(report::Anchor::start, 0).bottom() - 150) <= 2);
  const auto upwards = at(report::Anchor::start, 90);
  CHECK(upwards.height() > upwards.width());
  CHECK(std::abs(upwards.bottom() - 150) <= 4);
}

TEST_CASE("a figure on the screen fills the same frame as in a file", "[ui]") {
  const Screen screen;
  report::Figure figure;
  figure.title = "A figure";
  report::Chart chart{"", {"x", 0, 1, report::AxisScale::linear}, {"y", 0, 1, report::AxisScale::linear}, {}};
  chart.layers.emplace_back(report::Line{{0, 0.5, 1}, {0.5, 40, 0.5}, 0, ""});
  figure.charts.push_back(chart);
  figure.chart_width_px = 400, figure.chart_height_px = 300;
  const auto sheet = painted([&](report::Canvas& canvas) { report::draw(canvas, figure); });
  int above = 0;
  for (int x = 0; x < 400; ++x) above += sheet.pixel(x, 4) != kPaper ? 1 : 0;
  CHECK(above == 0);  // the line leaves the chart's range, but is clipped at its frame
  CHECK(inked(sheet).width() > 350);
}
