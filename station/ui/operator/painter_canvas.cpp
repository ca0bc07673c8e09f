#include "station/ui/operator/painter_canvas.hpp"

#include <QFontMetricsF>
#include <QGuiApplication>
#include <QPolygonF>
#include <algorithm>

namespace turnpoint::ui {

namespace {

QPointF point_of(const report::Point& point) { return {point.first, point.second}; }

QPolygonF points_of(const std::vector<report::Point>& points) {
  QPolygonF polygon;
  for (const auto& point : points) polygon << point_of(point);
  return polygon;
}

/// Converts dash lengths from px, as figures give them, to widths of the pen, as a QPen needs them.
QList<qreal> dashes_of(const report::Paint& paint) {
  QList<qreal> dashes;
  for (const auto& part : QString::fromStdString(paint.dash).split(' ', Qt::SkipEmptyParts))
    dashes << part.toDouble() / paint.width;
  return dashes;
}

}  // namespace

PainterCanvas::~PainterCanvas() {
  while (saved_-- > 0) painter_.restore();
}

void PainterCanvas::begin(double width, double height, const std::string& /*title*/) {
  painter_.save(), ++saved_;
  const double scale = std::min(into_.width() / width, into_.height() / height);
  painter_.translate(into_.center());
  painter_.scale(scale, scale);
  painter_.translate(-width / 2, -height / 2);
}

QColor PainterCanvas::shown(const std::string& colour) const {
  const QColor given(QString::fromStdString(colour));
  if (tone_ == Tone::paper) return given;
  // White becomes the dark theme's card, and black nearly white.
  constexpr float darkest = 0.13F, lightest = 0.96F;
  float hue = 0, saturation = 0, lightness = 0, alpha = 1;
  given.getHslF(&hue, &saturation, &lightness, &alpha);
  return QColor::fromHslF(std::max(0.0F, hue), saturation, lightest - (lightest - darkest) * lightness,
                          alpha);
}

void PainterCanvas::use(const report::Paint& paint) {
  QPen pen(Qt::NoPen);
  if (!paint.stroke.empty() && paint.width > 0) {
    pen = QPen(shown(paint.stroke), paint.width, Qt::SolidLine, Qt::FlatCap, Qt::RoundJoin);
    if (const auto dashes = dashes_of(paint); !dashes.isEmpty()) pen.setDashPattern(dashes);
  }
  painter_.setPen(pen);
  painter_.setBrush(paint.fill.empty() ? QBrush(Qt::NoBrush) : QBrush(shown(paint.fill)));
  painter_.setOpacity(paint.opacity);
}

void PainterCanvas::line(report::Point from, report::Point to, const report::Paint& paint) {
  use(paint);
  painter_.drawLine(point_of(from), point_of(to));
}

void PainterCanvas::polyline(const std::vector<report::Point>& points, const report::Paint& paint) {
  use(paint);
  painter_.drawPolyline(points_of(points));
}

void PainterCanvas::polygon(const std::vector<report::Point>& points, const report::Paint& paint) {
  use(paint);
  painter_.drawPolygon(points_of(points));
}

void PainterCanvas::rectangle(report::Point corner, double width, double height, const report::Paint& paint) {
  use(paint);
  painter_.drawRect(QRectF(point_of(corner), QSizeF(width, height)));
}

void PainterCanvas::circle(report::Point centre, double radius, const report::Paint& paint) {
  use(paint);
  painter_.drawEllipse(point_of(centre), radius, radius);
}

void PainterCanvas::text(report::Point at, const std::string& text, double size, report::Anchor anchor,
                         const std::string& colour, int weight, double degrees) {
  // Figures use font sizes in half pixels, but a QFont has whole pixels. So use a font of ten times the size
  // and scale it down.
  constexpr int fine = 10;
  QFont font(QGuiApplication::font().families().value(0));
  font.setPixelSize(static_cast<int>(size * fine));
  font.setWeight(weight >= 600 ? QFont::DemiBold : QFont::Normal);
  const auto words = QString::fromStdString(text);
  const double width = QFontMetricsF(font).horizontalAdvance(words);
  painter_.save();
  painter_.translate(point_of(at));
  painter_.rotate(-degrees);
  painter_.scale(1.0 / fine, 1.0 / fine);
  painter_.setFont(font);
  painter_.setOpacity(1);
  painter_.setPen(shown(colour));
  const double left = anchor == report::Anchor::start    ? 0
                      : anchor == report::Anchor::middle ? width / 2
                                                         : width;
  painter_.drawText(QPointF(-left, 0), words);
  painter_.restore();
}

void PainterCanvas::begin_clip(report::Point corner, double width, double height) {
  painter_.save(), ++saved_;
  painter_.setClipRect(QRectF(point_of(corner), QSizeF(width, height)));
}

void PainterCanvas::end_clip() { painter_.restore(), --saved_; }

}  // namespace turnpoint::ui
