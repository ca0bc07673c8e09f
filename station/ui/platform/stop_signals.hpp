#pragma once
#include <QObject>
#include <QSocketNotifier>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "station/system/stop_signals.hpp"

namespace turnpoint::ui {

/// The stop signals of a program with a screen (see system::StopSignals). Before the first page they end the
/// process at once, because no amplifier is armed and no data are being written. After take_over() the first
/// signal ends the event loop, so that a running session ends cleanly. Create this object on the GUI thread
/// and destroy it before the application object. If something holds the program up for kPatience after the
/// signal, such as a disk that does not answer, the program says so and ends nevertheless. Qt's own handlers
/// on eglfs and linuxfb would end the program without running destructors; Application switches them off.
class StopSignals : public QObject {
 public:
  /// Throws std::system_error if no descriptor for waking the event loop can be created.
  StopSignals();
  /// The time after the first signal in which the program can end by itself. A service manager would kill it
  /// after 5 s, without a word.
  static constexpr std::chrono::milliseconds kPatience{2500};

  ~StopSignals() override;  ///< restores the signal handlers that were in force before take_over()

  /// From now on a signal ends the event loop. Call this before starting anything that must end cleanly.
  /// Further calls have no effect.
  void take_over();

  /// What is said if the program does not end by itself. It is called on another thread, at a time when the
  /// program may be closing its pages. Call this before take_over().
  void say_if_held_up(std::function<std::string()> kept) { kept_ = std::move(kept); }

 private:
  void end_in_time(const std::stop_token& ended) const;

  system::StopSignals signals_;
  QSocketNotifier woken_;
  std::function<std::string()> kept_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread patience_;
};

}  // namespace turnpoint::ui
