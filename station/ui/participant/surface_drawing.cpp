#include "station/ui/participant/surface_drawing.hpp"

#include <QFontMetricsF>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

namespace turnpoint::ui {

namespace {

/// Smallest ratio of width to length of the drawn strip. A slimmer strip would look like a line on a small
/// panel.
constexpr double kSlimmest = 1.0 / 11;
constexpr double kTick_mm = 10, kLabel_mm = 50;
constexpr double kFinger = 5;  // width of the drawn finger, in units of Layout::unit

QColor mixed(const QColor& a, const QColor& b, double part_of_b) {
  return QColor::fromRgbF(static_cast<float>(a.redF() + (b.redF() - a.redF()) * part_of_b),
                          static_cast<float>(a.greenF() + (b.greenF() - a.greenF()) * part_of_b),
                          static_cast<float>(a.blueF() + (b.blueF() - a.blueF()) * part_of_b));
}

QFont font_of(double pixels) {
  QFont font;
  font.setPixelSize(static_cast<int>(std::ceil(pixels)));
  return font;
}

}  // namespace

/// The layout in pixels. x(mm) is the position at `mm` from the wide end, whether that end is at the left or
/// at the right.
struct SurfaceDrawing::Layout {
  double left = 0, right = 0;  ///< x of the two ends of the strip
  double axis_y = 0;           ///< y of the strip's centre line
  double px_per_mm = 1;        ///< scale along the strip
  double wide_half = 0, narrow_half = 0;
  double scale_text = 0, flag_text = 0, flag_height = 0;
  /// a twentieth of the height; widths of strokes and gaps are multiples of it, so that they grow with the
  /// item
  double unit = 1;
  double length_mm = 1;
  bool wide_left = true;

  double x(double mm) const { return wide_left ? left + mm * px_per_mm : right - mm * px_per_mm; }
  double half(double mm) const { return wide_half + (narrow_half - wide_half) * mm / length_mm; }
};

SurfaceDrawing::SurfaceDrawing(QQuickItem* parent) : QQuickPaintedItem(parent) {
  setAntialiasing(true);
  connect(this, &SurfaceDrawing::changed, this, [this] { update(); });
}

SurfaceDrawing::Layout SurfaceDrawing::layout() const {
  Layout at;
  at.unit = std::min(height() / 20, width() / 60);
  at.wide_left = surface_.wide_end_left;
  at.length_mm = surface_.length_mm;
  at.scale_text = std::max(text_pixels_, 1.8 * at.unit);
  at.flag_text = std::max(text_pixels_, 2.3 * at.unit);
  at.flag_height = std::max(3.6 * at.unit, 1.4 * at.flag_text);
  // The scale's last number is centred on the end of the strip, so the margin must have room for half of the
  // number.
  const double last =
      QFontMetricsF(font_of(at.scale_text)).horizontalAdvance(QString::number(surface_.length_mm, 'f', 0));
  const double driver = 3.2 * at.unit, margin = std::max(1.8 * at.unit, 0.5 * last + 2);
  at.left = surface_.wide_end_left ? driver + margin : margin;
  at.right = width() - (surface_.wide_end_left ? margin : driver + margin);
  at.px_per_mm = (at.right - at.left) / surface_.length_mm;
  const double slim = 2 * surface_.wide_half_width_mm / surface_.length_mm;
  const double across = at.px_per_mm * std::max(1.0, kSlimmest / slim);
  const double above = at.flag_height + 2 * at.unit, below = 2.2 * at.unit + 1.3 * at.scale_text;
  const double room = std::clamp(0.5 * (height() - above - below), at.unit, 4.6 * at.unit);
  const double shrink = std::min(1.0, room / (across * surface_.wide_half_width_mm));
  at.wide_half = surface_.wide_half_width_mm * across * shrink;
  at.narrow_half = surface_.narrow_half_width_mm * across * shrink;
  at.axis_y = above + room;
  return at;
}

double SurfaceDrawing::xOf(double mm) const { return surface_.length_mm > 0 ? layout().x(mm) : 0; }

double SurfaceDrawing::mmAt(double x) const {
  if (surface_.length_mm <= 0) return 0;
  const Layout at = layout();
  return std::clamp((at.wide_left ? x - at.left : at.right - x) / at.px_per_mm, 0.0, surface_.length_mm);
}

void SurfaceDrawing::paint(QPainter* painter) {
  if (surface_.length_mm <= 0 || surface_.wide_half_width_mm <= 0 || width() <= 0 || height() <= 0) return;
  painter->setRenderHint(QPainter::Antialiasing);
  const Layout at = layout();
  paint_strip(*painter, at);
  paint_scale(*painter, at);
  if (show_finger_) paint_finger(*painter, at);
  if (has_mark_) paint_mark(*painter, at);
}

void SurfaceDrawing::paint_strip(QPainter& painter, const Layout& at) const {
  const double x0 = at.x(0), x1 = at.x(surface_.length_mm);
  const double toward = at.wide_left ? 1 : -1;

  // The transducer: a block with its bolt. It shows which end of the strip is which.
  const double block = 2.6 * at.unit, block_half = at.wide_half + 0.7 * at.unit;
  const QRectF driver =
      QRectF(x0 - toward * block, at.axis_y - block_half, toward * block, 2 * block_half).normalized();
  painter.setPen(Qt::NoPen);
  painter.setBrush(mixed(ink_, paper_, 0.25));
  painter.drawRoundedRect(driver, 0.5 * at.unit, 0.5 * at.unit);
  painter.setBrush(mixed(ink_, paper_, 0.6));
  painter.drawEllipse(driver.center(), 0.55 * at.unit, 0.55 * at.unit);

  QPainterPath strip;
  strip.moveTo(x0, at.axis_y - at.wide_half);
  strip.lineTo(x1, at.axis_y - at.narrow_half);
  strip.lineTo(x1, at.axis_y + at.narrow_half);
  strip.lineTo(x0, at.axis_y + at.wide_half);
  strip.closeSubpath();
  // The strip has uniform shading along its length, because a change would suggest where the smooth part
  // ends.
  QLinearGradient metal(0, at.axis_y - at.wide_half, 0, at.axis_y + at.wide_half);
  metal.setColorAt(0, mixed(paper_, ink_, 0.10));
  metal.setColorAt(0.45, mixed(paper_, ink_, 0.16));
  metal.setColorAt(1, mixed(paper_, ink_, 0.26));
  painter.setBrush(metal);
  QPen outline(mixed(ink_, paper_, 0.35), std::max(1.0, 0.14 * at.unit));
  outline.setJoinStyle(Qt::MiterJoin);
  painter.setPen(outline);
  painter.drawPath(strip);
}

void SurfaceDrawing::paint_scale(QPainter& painter, const Layout& at) const {
  painter.setFont(font_of(at.scale_text));
  const QFontMetricsF metrics(painter.font());
  const double y0 = at.axis_y + at.wide_half + 0.9 * at.unit;
  const QColor colour = mixed(ink_, paper_, 0.15);
  for (int i = 0; i * kTick_mm <= surface_.length_mm + 1e-9; ++i) {
    const double mm = i * kTick_mm;
    const bool labelled = std::fmod(mm, kLabel_mm) < 1e-9;
    painter.setPen(QPen(colour, std::max(1.0, 0.1 * at.unit)));
    painter.drawLine(QPointF(at.x(mm), y0), QPointF(at.x(mm), y0 + (labelled ? 1.0 : 0.5) * at.unit));
    const QString label = QString::number(static_cast<int>(mm));
    if (!labelled || behind_finger(at, mm, metrics.horizontalAdvance(label))) continue;
    painter.drawText(
        QPointF(at.x(mm) - metrics.horizontalAdvance(label) / 2, y0 + 1.3 * at.unit + metrics.ascent()),
        label);
  }
}

/// True if the finger covers part of this number of the scale. The number is then left out, because half a
/// number would be misread.
bool SurfaceDrawing::behind_finger(const Layout& at, double mm, double width_px) const {
  if (!show_finger_) return false;
  return std::abs(at.x(mm) - finger_x(at)) < 0.5 * (width_px + kFinger * at.unit) + 0.4 * at.unit;
}

/// The finger is drawn exactly below the mark, because a position to its left or right could favour an
/// answer.
double SurfaceDrawing::finger_x(const Layout& at) const {
  return at.x(has_mark_ ? mark_mm_ : 0.5 * surface_.length_mm);
}

void SurfaceDrawing::paint_mark(QPainter& painter, const Layout& at) const {
  const double x = at.x(mark_mm_), half = at.half(mark_mm_), u = at.unit;
  painter.setPen(QPen(ink_, std::max(2.0, 0.28 * u), Qt::SolidLine, Qt::FlatCap));
  painter.drawLine(QPointF(x, at.axis_y - half), QPointF(x, at.axis_y + half));

  // The pointer ends at the strip's edge. Its number is the position on the scale that is printed on the real
  // surface.
  const double tip_y = at.axis_y - half - 0.25 * u;
  const double flag_y = 0.2 * u, flag_height = at.flag_height;
  QPainterPath pointer;
  pointer.moveTo(x, tip_y);
  pointer.lineTo(x - 1.0 * u, tip_y - 1.7 * u);
  pointer.lineTo(x + 1.0 * u, tip_y - 1.7 * u);
  pointer.closeSubpath();
  painter.setPen(Qt::NoPen);
  painter.setBrush(accent_);
  painter.drawPath(pointer);
  painter.drawRect(QRectF(x - 0.22 * u, flag_y + flag_height - 0.2 * u, 0.44 * u,
                          tip_y - 1.6 * u - flag_y - flag_height + 0.4 * u));

  QFont font = font_of(at.flag_text);
  font.setWeight(QFont::DemiBold);
  painter.setFont(font);
  const QFontMetricsF metrics(font);
  const QString label = QString::number(mark_mm_, 'g', 5) + " mm";
  const double flag_width = metrics.horizontalAdvance(label) + 2.4 * u;
  const double flag_x = std::clamp(x - flag_width / 2, 0.0, std::max(0.0, width() - flag_width));
  const QRectF flag(flag_x, flag_y, flag_width, flag_height);
  painter.drawRoundedRect(flag, 0.6 * u, 0.6 * u);
  painter.setPen(paper_);
  painter.drawText(flag, Qt::AlignCenter, label);
}

void SurfaceDrawing::paint_finger(QPainter& painter, const Layout& at) const {
  const double u = at.unit;
  const double x = finger_x(at);
  const double tip_y = at.axis_y - (has_mark_ ? 0.2 : 1.4) * u, width_px = kFinger * u;

  // The finger has no lower end; it fades out at the bottom of the drawing.
  const double bottom = height();
  QPainterPath finger;
  finger.moveTo(x - width_px / 2, bottom);
  finger.lineTo(x - width_px / 2, tip_y + 0.62 * width_px);
  finger.cubicTo(x - width_px / 2, tip_y + 0.1 * width_px, x - 0.28 * width_px, tip_y, x, tip_y);
  finger.cubicTo(x + 0.28 * width_px, tip_y, x + width_px / 2, tip_y + 0.1 * width_px, x + width_px / 2,
                 tip_y + 0.62 * width_px);
  finger.lineTo(x + width_px / 2, bottom);
  const auto fading = [&](const QColor& colour) {
    QLinearGradient fade(0, tip_y, 0, bottom);
    QColor gone = colour;
    gone.setAlpha(0);
    fade.setColorAt(0, colour);
    fade.setColorAt(0.45, colour);
    fade.setColorAt(1, gone);
    return fade;
  };
  painter.setPen(QPen(QBrush(fading(ink_)), std::max(1.5, 0.22 * u)));
  painter.setBrush(fading(mixed(paper_, ink_, 0.04)));
  painter.drawPath(finger);
  QPainterPath nail;
  nail.addRoundedRect(QRectF(x - 1.3 * u, tip_y + 0.5 * u, 2.6 * u, 3.0 * u), 1.25 * u, 1.25 * u);
  painter.setPen(QPen(mixed(ink_, paper_, 0.3), std::max(1.0, 0.14 * u)));
  painter.setBrush(mixed(paper_, ink_, 0.12));
  painter.drawPath(nail);

  // Two arrows along the strip show that the finger slides to and fro.
  painter.setBrush(accent_);
  for (const int side : {-1, 1}) {
    const double from = x + side * 3.4 * u, to = x + side * 6.6 * u, y = at.axis_y;
    painter.setPen(QPen(accent_, 0.5 * u, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(QPointF(from, y), QPointF(to - side * 0.4 * u, y));
    painter.setPen(Qt::NoPen);
    QPainterPath head;
    head.moveTo(to + side * 0.9 * u, y);
    head.lineTo(to - side * 0.7 * u, y - 0.95 * u);
    head.lineTo(to - side * 0.7 * u, y + 0.95 * u);
    head.closeSubpath();
    painter.drawPath(head);
  }
}

}  // namespace turnpoint::ui

#include "moc_surface_drawing.cpp"
