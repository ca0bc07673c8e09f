#pragma once
#include <QObject>
#include <QTimer>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "station/session/session.hpp"
#include "station/ui/operator/live_model.hpp"
#include "station/ui/operator/report_model.hpp"
#include "station/ui/participant/frame_watch.hpp"
#include "station/ui/participant/session_bridge.hpp"
#include "station/view/live_view.hpp"

namespace turnpoint::io {
class TouchReader;
}

namespace turnpoint::ui {

/// Runs sessions behind the pages, one at a time, each on its own thread. Connects a session with the pages
/// and inputs, the kernel's times of touches, the operator's live view, and the report at the end. GUI thread
/// only.
class SessionRunner : public QObject {
  Q_OBJECT

 public:
  explicit SessionRunner(QObject* parent = nullptr);
  ~SessionRunner() override;  ///< stops a session that is still running

  SessionBridge& bridge() { return bridge_; }
  LiveModel& live() { return live_; }
  ReportModel& report() { return report_; }

  /// Sets the window that shows the pages. Its touches are stamped with the time, and its late frames are
  /// counted.
  void watch(QQuickWindow* window);

  /// Begins a session, after the previous one has ended. `language` is that of the operator. Throws the
  /// errors of io::TouchReader if the rig's touch panel does not exist.
  void begin(session::Setup setup, const std::string& language = "en");
  bool running() const { return thread_.joinable() && !over_; }
  void ask_to_stop();

  /// Says how many trials of the running session are stored. The function that is returned may be called on
  /// any thread, also after this object is gone.
  std::function<std::string()> kept() const;

  /// Waits for the session's end and returns its summary; empty if no session was begun. Throws the exception
  /// that ended the session, if any.
  std::optional<session::Summary> finish();

 Q_SIGNALS:
  /// Emitted when the session is over and its end page is on the screen.
  void over();

 private:
  void run();
  void open_touch();
  void show_failure();

  session::Setup setup_;
  std::string language_;  ///< language of the operator
  session::Inputs inputs_;
  SessionBridge bridge_;
  LiveModel live_;
  ReportModel report_;
  FrameWatch frames_;
  std::optional<std::int64_t> flash_ns_;  ///< when the last flash was due
  QTimer life_;                           ///< reports to the session that the pages' event loop is running
  std::unique_ptr<io::TouchReader> touch_;
  std::unique_ptr<view::LiveView> view_;
  std::optional<session::Summary> summary_;
  std::exception_ptr failure_;
  std::atomic<bool> over_ = false;
  std::atomic<bool> leaving_ = false;  ///< the program ends, so nobody will read a report
  /// stored since the session began or was resumed; -1 if none is running
  std::shared_ptr<std::atomic<int>> stored_ = std::make_shared<std::atomic<int>>(-1);
  // The last member, so that the thread is joined before anything that it uses is destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::ui
