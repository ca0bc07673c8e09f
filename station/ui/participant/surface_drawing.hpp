#pragma once
#include <QColor>
#include <QQmlEngine>
#include <QQuickPaintedItem>

#include "station/rig/physical.hpp"

namespace turnpoint::ui {

/// The outline of a surface as a value that pages pass to a SurfaceDrawing.
struct SurfaceOutline : rig::Outline {
  Q_GADGET
  QML_ANONYMOUS
  Q_PROPERTY(double lengthMm MEMBER length_mm)
  Q_PROPERTY(bool wideEndLeft MEMBER wide_end_left)
 public:
  bool operator==(const SurfaceOutline&) const = default;
};

/// The surface seen from above, to scale: the tapered strip with its transducer at the wide end, a millimetre
/// scale, the mark, and a fingertip that shows where to slide. It redraws only when a property changes.
/// Lengths in mm; positions are measured from the wide end. Its numbers are never smaller than `textPixels`.
class SurfaceDrawing : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(turnpoint::ui::SurfaceOutline surface MEMBER surface_ NOTIFY changed)
  Q_PROPERTY(bool hasMark MEMBER has_mark_ NOTIFY changed)
  Q_PROPERTY(double markMm MEMBER mark_mm_ NOTIFY changed)
  Q_PROPERTY(bool showFinger MEMBER show_finger_ NOTIFY changed)
  Q_PROPERTY(double textPixels MEMBER text_pixels_ NOTIFY changed)
  Q_PROPERTY(QColor ink MEMBER ink_ NOTIFY changed)
  Q_PROPERTY(QColor paper MEMBER paper_ NOTIFY changed)
  Q_PROPERTY(QColor accent MEMBER accent_ NOTIFY changed)

 public:
  explicit SurfaceDrawing(QQuickItem* parent = nullptr);
  void paint(QPainter* painter) override;

  /// xOf() converts a position in mm from the wide end to an x in pixels; mmAt() converts it back.
  Q_INVOKABLE double xOf(double mm) const;
  Q_INVOKABLE double mmAt(double x) const;

 Q_SIGNALS:
  void changed();

 private:
  struct Layout;
  Layout layout() const;
  void paint_strip(QPainter& painter, const Layout& at) const;
  void paint_scale(QPainter& painter, const Layout& at) const;
  void paint_mark(QPainter& painter, const Layout& at) const;
  void paint_finger(QPainter& painter, const Layout& at) const;
  double finger_x(const Layout& at) const;
  bool behind_finger(const Layout& at, double mm, double width_px) const;

  SurfaceOutline surface_;
  bool has_mark_ = false;
  double mark_mm_ = 0;
  bool show_finger_ = false;
  double text_pixels_ = 11;
  QColor ink_ = Qt::black, paper_ = Qt::white, accent_ = Qt::black;
};

}  // namespace turnpoint::ui
