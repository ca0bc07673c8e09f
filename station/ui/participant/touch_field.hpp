#pragma once
#include <QQuickItem>
#include <QTimer>

#include "station/ui/participant/session_bridge.hpp"
#include "station/ui/participant/touch_judge.hpp"

namespace turnpoint::ui {

/// Takes every touch (and mouse press) on its area and lets a TouchJudge find the answer. `row` is the item
/// that contains the answer buttons: `count` equal buttons in rows of `columns`, `gap` pixels apart. It must
/// be inside the field. The judge is open while `open` is true.
class TouchField : public QQuickItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(turnpoint::ui::SessionBridge* bridge MEMBER bridge_ REQUIRED)
  Q_PROPERTY(QQuickItem* row MEMBER row_ REQUIRED)
  Q_PROPERTY(int count MEMBER count_)
  Q_PROPERTY(int columns MEMBER columns_)
  Q_PROPERTY(double gap MEMBER gap_)
  Q_PROPERTY(double pixelsPerMm MEMBER pixels_per_mm_)
  Q_PROPERTY(bool open READ is_open WRITE set_open NOTIFY openChanged)
  Q_PROPERTY(int pressed READ pressed NOTIFY pressedChanged)

 public:
  explicit TouchField(QQuickItem* parent = nullptr);

  bool is_open() const { return judge_.is_open(); }
  // Qt calls this function by its name, as the setter of the property `open` (NOLINT)
  void set_open(bool open);
  int pressed() const { return pressed_; }
  /// Takes one more answer, because the session did not accept the last one.
  Q_INVOKABLE void again();

 Q_SIGNALS:
  void openChanged();
  void pressedChanged();

 protected:
  void touchEvent(QTouchEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;

 private:
  int target_at(QPointF position) const;
  void down(int id, QPointF position, double diameter_mm);
  void settle();
  void update_pressed();

  SessionBridge* bridge_ = nullptr;
  QQuickItem* row_ = nullptr;
  int count_ = 0;
  int columns_ = 1;
  double gap_ = 0;
  double pixels_per_mm_ = 4;
  TouchJudge judge_;
  QTimer timer_;
  int pressed_ = -1;
};

}  // namespace turnpoint::ui
