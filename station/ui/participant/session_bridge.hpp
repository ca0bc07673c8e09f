#pragma once
#include <QObject>
#include <QPointF>
#include <QQmlEngine>
#include <QTimer>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "station/session/inputs.hpp"
#include "station/session/page.hpp"
#include "station/ui/participant/page_model.hpp"

namespace turnpoint::ui {

/// Connects the session's thread and the GUI thread. Pages come in by show(); the participant's actions go to
/// the sink with their CLOCK_MONOTONIC time. The sink is called on the GUI thread and must be thread-safe
/// (session::Inputs::push is). Everything except show() belongs to the GUI thread.
class SessionBridge : public QObject, public session::Display {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(turnpoint::ui::PageModel* page READ page CONSTANT)

 public:
  /// The touch id for mouse presses; real touch ids are not negative.
  static constexpr int kMouse = -1;

  using Clock = std::function<std::int64_t()>;
  using Sink = std::function<void(session::Input)>;
  /// A function that returns the kernel's time of a touch at (x, y) (each from 0 to 1 across the window) that
  /// Qt delivered at `seen_ns`. Its result is empty if that time is unknown.
  using KernelTime = std::function<std::optional<std::int64_t>(double x, double y, std::int64_t seen_ns)>;

  SessionBridge(Clock clock, Sink sink, QObject* parent = nullptr);

  /// From now on, `kernel_time` gives the times of touches. A touch whose time it knows gets the quality
  /// `kernel`. The window must fill the panel.
  void set_kernel_time(KernelTime kernel_time) { kernel_time_ = std::move(kernel_time); }

  /// Shows a page. May be called on any thread; returns at once. Pages appear in the order of the calls.
  void show(const session::Page& page) override;
  /// Moves the bars that guide the finger. Like show(), it may be called on any thread and returns at once.
  void guide(const session::Guidance& guidance) override;

  /// Stamps each touch and mouse press anywhere on the window with the time. A touch that does not become an
  /// answer within a moment is reported as `Touch`.
  Q_INVOKABLE void watch(QObject* window);

  PageModel* page() { return &page_; }
  std::int64_t now_ns() const { return clock_(); }

  /// When a touch began, and its number, which no other touch has (the toolkit uses the ids of touches
  /// again).
  struct Stamp {
    std::int64_t time_ns = 0;
    int number = 0;  ///< 0 if watch() did not see the touch
  };
  /// The stamp by watch() of the newest touch with this id. The current time if watch() did not see it.
  Stamp stamped(int touch_id) const;

  /// Reports that a touch has just pressed an answer's button. The next frame must show the pressed button.
  void pressed() { Q_EMIT acknowledged(); }

  /// Reports an answer that the touch field accepted: this touch chose the answer `index`.
  void answer(int index, const Stamp& stamp);

  /// Reports that Continue or Done was pressed. Only the first press on a page counts.
  Q_INVOKABLE void next();
  /// Reports that Back was pressed on a question or an explanation. Only the first press on a page counts.
  Q_INVOKABLE void back();
  /// Reports that an example of an explanation was chosen.
  Q_INVOKABLE void choose(int index);
  Q_INVOKABLE void moveSlider(double value);
  Q_INVOKABLE void answerValue(double value);
  /// Reports that the participant asks for the intervals again. Only the first press on a page counts.
  Q_INVOKABLE void again();
  Q_INVOKABLE void pause();
  Q_INVOKABLE void stop();
  /// For the operator: repeat() makes the current trial void and presents it again, arm() arms the amplifier,
  /// annotate() stores a note.
  Q_INVOKABLE void repeat();
  Q_INVOKABLE void arm();
  Q_INVOKABLE void annotate(const QString& text);
  /// Reports by how many frames the screen was late during the finished trial; 0 is not reported.
  void frames_lost(int frames);
  /// Reports when the frame with a flash was handed to the screen, and when the flash was due.
  void signal_shown(std::int64_t time_ns, std::int64_t due_ns);

 Q_SIGNALS:
  /// Emitted when a page has been applied, even if nothing changed.
  void shown();
  void acknowledged();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  /// A touch that may still become an answer.
  struct Pending {
    int id = 0;
    Stamp stamp;          ///< with the time at which Qt delivered the touch
    double x = 0, y = 0;  ///< position from 0 to 1 in the window
  };

  void note_touch(int id, QPointF position, const QObject* window);
  void push_touch(session::input::Any content, const Pending& touch);
  void flush();
  void push(session::input::Any content);
  Clock clock_;
  Sink sink_;
  KernelTime kernel_time_;
  PageModel page_;
  bool left_ = false;  ///< somebody has pressed Continue or Done on this page
  std::vector<Pending> pending_;
  int touches_ = 0;  ///< number of the newest touch
  QTimer flush_;
};

}  // namespace turnpoint::ui
