#pragma once
#include <QQuickPaintedItem>

#include "station/desk/scene_figures.hpp"

namespace turnpoint::ui {

/// A drawing in a form that can be a QML property.
struct Picture {
  Q_GADGET

 public:
  desk::Drawing draw;
};

/// Converts a drawing to the value of a QML property.
QVariant to_variant(const desk::Drawing& drawing);

/// Shows one figure, laid out for the size of this item with text of `textPixels`. Each new picture is drawn
/// only once.
class FigureView : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QVariant picture READ picture WRITE set_picture NOTIFY pictureChanged)
  Q_PROPERTY(double textPixels MEMBER text_pixels_)

 public:
  explicit FigureView(QQuickItem* parent = nullptr);
  QVariant picture() const { return QVariant::fromValue(picture_); }
  void set_picture(const QVariant& picture);  // the setter of a QML property must have this name (NOLINT)
  void paint(QPainter* painter) override;

 Q_SIGNALS:
  void pictureChanged();

 private:
  Picture picture_;
  double text_pixels_ = 12;
};

}  // namespace turnpoint::ui
