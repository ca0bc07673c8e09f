#pragma once
#include <QColor>
#include <QQuickPaintedItem>
#include <QString>

namespace turnpoint::ui {

/// A symbol drawn in strokes, as wide as it is high: "tick", "cross", "clock", "chevrons" (speed), "rings"
/// (accuracy), "bars" (pause), "alert", "backspace", "shield", "tool" (an arrow), "dots", "run", "sheet",
/// "list", "gauge", "minus", "plus"; any other name draws nothing. It is painted, because on the frame buffer
/// a Qt Quick Shape is not clipped to a scrolling area.
class Glyph : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QString name MEMBER name_ NOTIFY changed REQUIRED)
  Q_PROPERTY(QColor color MEMBER color_ NOTIFY changed REQUIRED)
  Q_PROPERTY(
      double weight MEMBER weight_ NOTIFY changed)  ///< width of the strokes, relative to the symbol's height

 public:
  explicit Glyph(QQuickItem* parent = nullptr);
  void paint(QPainter* painter) override;

 Q_SIGNALS:
  void changed();

 private:
  QString name_;
  QColor color_;
  double weight_ = 0.1;
};

}  // namespace turnpoint::ui
