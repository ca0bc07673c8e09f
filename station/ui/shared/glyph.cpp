#include "station/ui/shared/glyph.hpp"

#include <QHash>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <initializer_list>

namespace turnpoint::ui {

namespace {

// the strokes are described by coordinates in a square with sides of this length
constexpr double kUnits = 24;

using Stroke = std::initializer_list<QPointF>;

QPainterPath lines(std::initializer_list<Stroke> strokes) {
  QPainterPath path;
  for (const auto& stroke : strokes) path.addPolygon(QPolygonF(QList<QPointF>(stroke)));
  return path;
}

QPainterPath with_circles(QPainterPath path, std::initializer_list<double> radii) {
  for (const double radius : radii) path.addEllipse(QPointF(12, 12), radius, radius);
  return path;
}

QPainterPath shield() {
  auto path = lines({{{8, 12}, {11, 15}, {16, 9}}});
  path.moveTo(12, 2.5);
  path.lineTo(20, 5.5);
  path.lineTo(20, 11.5);
  path.cubicTo(20, 16, 16.5, 19.5, 12, 21.5);
  path.cubicTo(7.5, 19.5, 4, 16, 4, 11.5);
  path.lineTo(4, 5.5);
  path.closeSubpath();
  return path;
}

QPainterPath gauge() {
  QPainterPath path;
  path.arcMoveTo(2.5, 5, 19, 19, -20);
  path.arcTo(2.5, 5, 19, 19, -20, 220);
  path.moveTo(12, 14.5);
  path.lineTo(16.5, 9);
  return path;
}

/// Returns the outline of a symbol. A dot is a very short stroke, of which only the round ends are seen.
QPainterPath outline(const QString& name) {
  static const QHash<QString, QPainterPath> outlines{
      {"tick", lines({{{4, 13}, {10, 19}, {20, 6}}})},
      {"cross", lines({{{6, 6}, {18, 18}}, {{18, 6}, {6, 18}}})},
      {"clock", with_circles(lines({{{12, 7}, {12, 12.5}, {15.5, 14.5}}}), {9})},
      {"chevrons", lines({{{4, 5}, {10.5, 12}, {4, 19}}, {{13, 5}, {19.5, 12}, {13, 19}}})},
      {"rings", with_circles(lines({{{12, 11.9}, {12, 12.1}}}), {9.5, 4.5})},
      {"bars", lines({{{8.5, 5}, {8.5, 19}}, {{15.5, 5}, {15.5, 19}}})},
      {"alert",
       lines({{{12, 3}, {22, 20.5}, {2, 20.5}, {12, 3}}, {{12, 9.5}, {12, 14}}, {{12, 17.1}, {12, 17.2}}})},
      {"backspace", lines({{{9, 5}, {21, 5}, {21, 19}, {9, 19}, {3, 12}, {9, 5}},
                           {{12, 9.5}, {17, 14.5}},
                           {{17, 9.5}, {12, 14.5}}})},
      {"shield", shield()},
      {"tool", lines({{{3, 12}, {19, 12}}, {{13, 6}, {19, 12}, {13, 18}}})},
      {"dots", lines({{{6, 12}, {6, 12.1}}, {{12, 12}, {12, 12.1}}, {{18, 12}, {18, 12.1}}})},
      {"run", lines({{{7, 4}, {20, 12}, {7, 20}, {7, 4}}})},
      {"sheet", lines({{{5, 3}, {15, 3}, {19, 7}, {19, 21}, {5, 21}, {5, 3}},
                       {{9, 10}, {15, 10}},
                       {{9, 15}, {15, 15}}})},
      {"list", lines({{{4, 6}, {4, 6.1}},
                      {{9, 6}, {20, 6}},
                      {{4, 12}, {4, 12.1}},
                      {{9, 12}, {20, 12}},
                      {{4, 18}, {4, 18.1}},
                      {{9, 18}, {20, 18}}})},
      {"gauge", gauge()},
      {"previous", lines({{{15, 5}, {9, 12}, {15, 19}}})},
      {"next", lines({{{9, 5}, {15, 12}, {9, 19}}})},
      {"minus", lines({{{5, 12}, {19, 12}}})},
      {"plus", lines({{{5, 12}, {19, 12}}, {{12, 5}, {12, 19}}})}};
  return outlines.value(name);
}

}  // namespace

Glyph::Glyph(QQuickItem* parent) : QQuickPaintedItem(parent) {
  setAntialiasing(true);
  connect(this, &Glyph::changed, this, [this] { update(); });
  connect(this, &QQuickItem::heightChanged, this, [this] { setImplicitWidth(height()); });
}

void Glyph::paint(QPainter* painter) {
  const double scale = std::min(width(), height()) / kUnits;
  painter->translate(boundingRect().center());
  painter->scale(scale, scale);
  painter->translate(-kUnits / 2, -kUnits / 2);
  painter->setPen(QPen(color_, kUnits * weight_, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter->drawPath(outline(name_));
}

}  // namespace turnpoint::ui

#include "moc_glyph.cpp"
