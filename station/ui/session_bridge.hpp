#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QWindow>
#include <cstdint>
#include <functional>

#include "station/session/inputs.hpp"
#include "station/session/page.hpp"
#include "station/ui/page_model.hpp"

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
  using Clock = std::function<std::int64_t()>;
  using Sink = std::function<void(session::Input)>;

  SessionBridge(Clock clock, Sink sink, QObject* parent = nullptr);

  /// Any thread; returns at once. Pages appear in the order shown.
  void show(const session::Page& page) override;

  /// Reports each touch or mouse press on the window as `touch_down`, whatever it lands on.
  Q_INVOKABLE void watch(QObject* window);

  PageModel* page() { return &page_; }
  std::int64_t now_ns() const { return clock_(); }

  /// An answer that the touch field has judged; `time_ns` is when the touch began.
  void answer(int index, std::int64_t time_ns, session::TimeQuality quality);

  Q_INVOKABLE void next();
  Q_INVOKABLE void moveSlider(double value);
  Q_INVOKABLE void pause();
  Q_INVOKABLE void stop();

 signals:
  /// A page has been taken over (also when it equals the one before).
  void shown();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void push(session::InputKind kind, int value = 0, double number = 0);
  Clock clock_;
  Sink sink_;
  PageModel page_;
};

}  // namespace turnpoint::ui
