#pragma once
#include <QColor>
#include <QQuickPaintedItem>
#include <QString>

namespace turnpoint::ui {

/// A sign drawn in strokes, as wide as it is high: "tick", "cross", "clock", "chevrons" (speed), "rings"
/// (accuracy), "bars" (pause), "alert", "backspace", "shield", "tool", "dots", "minus", "plus"; any other
/// name draws nothing. Painted, and not a Shape of Qt Quick: on the frame buffer Qt does not keep those
/// within the place that scrolls around them.
class Glyph : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QString name MEMBER name_ NOTIFY changed REQUIRED)
  Q_PROPERTY(QColor color MEMBER color_ NOTIFY changed REQUIRED)
  Q_PROPERTY(double weight MEMBER weight_ NOTIFY changed)  ///< of the strokes, in heights of the sign

 public:
  explicit Glyph(QQuickItem* parent = nullptr);
  void paint(QPainter* painter) override;

 signals:
  void changed();

 private:
  QString name_;
  QColor color_;
  double weight_ = 0.1;
};

}  // namespace turnpoint::ui
