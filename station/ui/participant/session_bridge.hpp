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

/// Between the session's thread and the GUI's: pages come in by show(), what the participant does goes out to
/// the sink with its CLOCK_MONOTONIC time. The sink is called on the GUI thread and must be thread-safe
/// (session::Inputs::push is). Everything but show() belongs to the GUI thread.
class SessionBridge : public QObject, public session::Display {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(turnpoint::ui::PageModel* page READ page CONSTANT)

 public:
  /// The id under which mouse presses are stamped; touch ids are not negative.
  static constexpr int kMouse = -1;

  using Clock = std::function<std::int64_t()>;
  using Sink = std::function<void(session::Input)>;
  /// The kernel's time of a touch at (x, y), each 0 ... 1 of the window, that arrived at `seen_ns`; none if
  /// unknown.
  using KernelTime = std::function<std::optional<std::int64_t>(double x, double y, std::int64_t seen_ns)>;

  SessionBridge(Clock clock, Sink sink, QObject* parent = nullptr);

  /// From now on touches get the kernel's time where `kernel_time` knows it, and the quality that goes with
  /// it. The window must fill the panel.
  void set_kernel_time(KernelTime kernel_time) { kernel_time_ = std::move(kernel_time); }

  /// Any thread; returns at once. Pages appear in the order shown.
  void show(const session::Page& page) override;

  /// Stamps each touch and mouse press on the window, whatever it lands on. Those that no answer claims
  /// within a moment are reported as `touch_down`.
  Q_INVOKABLE void watch(QObject* window);

  PageModel* page() { return &page_; }
  std::int64_t now_ns() const { return clock_(); }

  /// When the touch with this id began, as stamped by watch(); now for one that was not seen.
  std::int64_t began_ns(int touch_id) const;

  /// A touch has just pressed an answer's button, which the next frame must show.
  void pressed() { emit acknowledged(); }

  /// An answer that the touch field has judged: the touch that began at `time_ns` chose the answer `index`.
  void answer(int index, std::int64_t time_ns);

  Q_INVOKABLE void next();
  Q_INVOKABLE void moveSlider(double value);
  Q_INVOKABLE void pause();
  Q_INVOKABLE void stop();
  /// The operator's: void the trial under way and present it again; arm the amplifier; keep a note.
  Q_INVOKABLE void repeat();
  Q_INVOKABLE void arm();
  Q_INVOKABLE void annotate(const QString& text);
  /// Frames that the screen lost during the trial that has just ended; 0 is not worth an event.
  void frames_lost(int frames);

 signals:
  /// A page has been taken over (also when it equals the one before).
  void shown();
  void acknowledged();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  /// A touch that may yet become an answer.
  struct Pending {
    int id = 0;
    std::int64_t time_ns = 0;  ///< the toolkit's
    double x = 0, y = 0;       ///< 0 ... 1 of the window
  };

  void note_touch(int id, QPointF position, const QObject* window);
  void push_touch(session::InputKind kind, int value, const Pending& touch);
  void flush();
  void push(session::InputKind kind, int value = 0, double number = 0);
  Clock clock_;
  Sink sink_;
  KernelTime kernel_time_;
  PageModel page_;
  std::vector<Pending> pending_;
  QTimer flush_;
};

}  // namespace turnpoint::ui
