#pragma once
#include <stop_token>
#include <string>

#include "station/cli/command.hpp"
#include "station/system/progress.hpp"
#include "station/system/stop_signals.hpp"

namespace turnpoint::cli {

/// Adds the option --progress to a command.
void add_progress(Command& command, bool& target);

/// Work of a command that may take long. While this object exists, the progress is shown, and the first stop
/// signal (Ctrl-C) requests a stop instead of ending the program: the work stops after the current unit, such
/// as a simulated session, and the command prints the results so far.
class LongWork {
 public:
  explicit LongWork(bool show_progress);

  void show(const std::string& what, int done, int of) { progress_.show(what, done, of); }
  std::stop_token stop() const { return stop_.get_token(); }
  /// Call this at the end of the work. If a signal stopped it, sets the exit status to 128 and the signal's
  /// number, and returns its name; otherwise returns "".
  std::string end(Context& context);

 private:
  std::stop_source stop_;
  system::Progress progress_;
  system::OnStopSignal on_signal_;
};

}  // namespace turnpoint::cli
