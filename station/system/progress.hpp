#pragma once
#include <chrono>
#include <deque>
#include <mutex>
#include <string>

namespace turnpoint::system {

/// Whether long work shows its progress.
enum class ShowProgress {
  on_terminal,  ///< only if standard error is a terminal
  always,       ///< also to a file or pipe, as separate lines, at most one every three seconds
};

/// Shows the progress of long work on standard error: what is being counted, the share that is done, and the
/// time left. On a terminal this is one line, which is overwritten several times a second and cleared at the
/// end.
class Progress {
 public:
  explicit Progress(ShowProgress show);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { clear(); }

  /// Call this after each unit of the work. May be called on any thread.
  void show(const std::string& what, int done, int of);
  /// Clears the line, so that something else can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  struct Mark {
    Clock::time_point time;
    int done = 0;
  };
  double left_s(int done, int of) const;

  std::mutex mutex_;
  bool terminal_ = false, shown_ = false, line_ = false;
  std::string what_;
  std::deque<Mark> marks_;  ///< the counts in the last 15 s, from which the speed is computed
  Clock::time_point last_;
};

/// The text that Progress shows: "simulated sessions: 137 of 1000 (13 %), 4 min left". `left_s` is negative
/// if the time left is not known.
std::string progress_in_words(const std::string& what, int done, int of, double left_s);

}  // namespace turnpoint::system
