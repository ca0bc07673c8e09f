#pragma once
#include <QQuickPaintedItem>
#include <QSvgRenderer>

namespace turnpoint::ui {

/// Shows one SVG document as large as it fits, its proportions kept. Still: it draws once a document.
class FigureView : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QString svg READ svg WRITE set_svg NOTIFY svgChanged)

 public:
  explicit FigureView(QQuickItem* parent = nullptr);
  QString svg() const { return svg_; }
  void set_svg(const QString& svg);  // NOLINT: the setter of a QML property
  void paint(QPainter* painter) override;

 signals:
  void svgChanged();

 private:
  QString svg_;
  QSvgRenderer renderer_;
};

}  // namespace turnpoint::ui
