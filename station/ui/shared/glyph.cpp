#include "station/ui/shared/glyph.hpp"

#include <QHash>
#include <QPainter>
#include <QSvgRenderer>

namespace turnpoint::ui {

namespace {

/// Strokes in a square of 24 units, in the syntax of SVG paths.
QString outline(const QString& name) {
  static const QHash<QString, QString> outlines{
      {"tick", "M4 13 L10 19 L20 6"},
      {"cross", "M6 6 L18 18 M18 6 L6 18"},
      {"clock", "M12 3 A9 9 0 1 1 11.99 3 M12 7 L12 12.5 L15.5 14.5"},
      {"chevrons", "M4 5 L10.5 12 L4 19 M13 5 L19.5 12 L13 19"},
      {"rings", "M12 2.5 A9.5 9.5 0 1 1 11.99 2.5 M12 7.5 A4.5 4.5 0 1 1 11.99 7.5 M12 11.9 L12 12.1"},
      {"bars", "M8.5 5 L8.5 19 M15.5 5 L15.5 19"},
      {"alert", "M12 3 L22 20.5 L2 20.5 Z M12 9.5 L12 14 M12 17.1 L12 17.2"},
      {"backspace", "M9 5 L21 5 L21 19 L9 19 L3 12 Z M12 9.5 L17 14.5 M17 9.5 L12 14.5"},
      {"shield",
       "M12 2.5 L20 5.5 L20 11.5 C20 16 16.5 19.5 12 21.5 C7.5 19.5 4 16 4 11.5 L4 5.5 Z M8 12 L11 15 L16 9"},
      {"tool", "M3 12 L19 12 M13 6 L19 12 L13 18"},
      {"dots", "M6 12 L6 12.1 M12 12 L12 12.1 M18 12 L18 12.1"},
      {"minus", "M5 12 L19 12"},
      {"plus", "M5 12 L19 12 M12 5 L12 19"}};
  return outlines.value(name);
}

}  // namespace

Glyph::Glyph(QQuickItem* parent) : QQuickPaintedItem(parent) {
  setAntialiasing(true);
  connect(this, &Glyph::changed, this, [this] { update(); });
  connect(this, &QQuickItem::heightChanged, this, [this] { setImplicitWidth(height()); });
}

void Glyph::paint(QPainter* painter) {
  const auto strokes = outline(name_);
  if (strokes.isEmpty()) return;
  const QString drawing =
      "<svg viewBox=\"0 0 24 24\"><path fill=\"none\" stroke=\"%1\" stroke-width=\"%2\" "
      "stroke-linecap=\"round\" "
      "stroke-linejoin=\"round\" d=\"%3\"/></svg>";
  QSvgRenderer renderer(drawing.arg(color_.name(), QString::number(24 * weight_), strokes).toUtf8());
  renderer.setAspectRatioMode(Qt::KeepAspectRatio);
  renderer.render(painter, boundingRect());
}

}  // namespace turnpoint::ui
