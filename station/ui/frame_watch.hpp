#pragma once
#include <QObject>
#include <QQuickWindow>
#include <atomic>
#include <cstdint>
#include <functional>

namespace turnpoint::ui {

/// Counts the frames by which a window was late: from the page asked for, or the finger that pressed an
/// answer, until that is on the screen, a participant should never wait longer than one refresh. Frames
/// beyond that are counted.
class FrameWatch : public QObject {
  Q_OBJECT

 public:
  using Clock = std::function<std::int64_t()>;
  FrameWatch(Clock clock, QObject* parent = nullptr);

  /// GUI thread. Follows this window; `refresh_Hz` at or below 0 counts as 60.
  void follow(QQuickWindow* window, double refresh_Hz);

  /// GUI thread: something new is to be shown. The next frame shows it, and one is drawn even where it looks
  /// the same, so that a later frame is never taken for this one.
  void asked();

  /// Frames lost since the last call.
  int take() { return lost_.exchange(0); }

  /// The frames lost where a page took `waited_ns`: whole refreshes beyond the first.
  static int lost(std::int64_t waited_ns, double refresh_Hz);

 private:
  void swapped();

  Clock clock_;
  QQuickWindow* window_ = nullptr;
  double refresh_Hz_ = 60;
  std::atomic<std::int64_t> asked_ns_{0};  ///< 0: nothing was
  std::atomic<int> lost_{0};
};

}  // namespace turnpoint::ui
