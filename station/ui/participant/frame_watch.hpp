#pragma once
#include <QObject>
#include <QQuickWindow>
#include <QTimer>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>

namespace turnpoint::ui {

/// Counts late frames from reported time spans. Where spans overlap, each frame is counted once. Times are
/// CLOCK_MONOTONIC; the caller reads the clock.
class LateFrames {
 public:
  /// `refresh_Hz` is the refresh rate of the screen; a value at or below 0 counts as 60.
  explicit LateFrames(double refresh_Hz) : refresh_Hz_(refresh_Hz > 0 ? refresh_Hz : 60) {}

  /// Reports a time span in which the screen could show nothing new.
  void waited(std::int64_t from_ns, std::int64_t to_ns);
  int count() const { return count_; }

  /// The number of frames lost during a wait: the number of whole refresh periods minus one.
  static int lost(std::int64_t waited_ns, double refresh_Hz);

 private:
  double refresh_Hz_;
  std::int64_t counted_ns_ = 0;  ///< end of the last wait that count_ includes; no time is counted twice
  int count_ = 0;
};

/// Counts the frames by which a window was late during a trial. A new page or a pressed answer should be
/// visible within one refresh. The event loop should also run once per refresh, because it shows pages and
/// takes touches. Each refresh beyond the first counts as a late frame. GUI thread only.
class FrameWatch : public QObject {
  Q_OBJECT

 public:
  using Clock = std::function<std::int64_t()>;
  FrameWatch(Clock clock, QObject* parent = nullptr);

  /// Follows this window; `refresh_Hz` at or below 0 counts as 60.
  void follow(QQuickWindow* window, double refresh_Hz);

  /// Call this when something new has to be shown. It requests a frame even if the window would look the
  /// same, so that the next frame always shows the new content. The first call begins the count.
  void asked();

  /// Like asked(), for something whose time matters: presented() says when its frame was handed to the
  /// screen.
  void timed();

  /// Ends the count and returns the number of late frames; 0 if no count had begun.
  int end();

 Q_SIGNALS:
  /// The first frame that was drawn after timed() was handed to the screen at this time. Emitted on the
  /// rendering thread.
  void presented(qint64 time_ns);

 private:
  void begin();
  void beat();
  void drawn();    ///< called on the rendering thread when it has taken over what the next frame shows
  void swapped();  ///< called on the rendering thread when a frame is on the screen
  void waited(std::int64_t from_ns);

  Clock clock_;
  QQuickWindow* window_ = nullptr;
  double refresh_Hz_ = 60;
  QTimer timer_;
  std::int64_t beat_ns_ = 0;
  /// time at which something new was requested; 0 if nothing is waiting
  std::atomic<std::int64_t> asked_ns_{0};
  std::atomic<bool> timed_ = false;  ///< timed() was called, and no frame has been drawn since
  std::atomic<bool> drawn_ = false;  ///< the frame that is being drawn is the one whose time matters
  std::mutex mutex_;
  LateFrames late_{60};  ///< guarded by mutex_
};

}  // namespace turnpoint::ui
