#include "station/system/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

namespace turnpoint::system {

namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::string time_in_words(double time_s) {
  if (time_s < 90) return fmt::format("{:.0f} s", std::ceil(time_s));
  if (time_s < 90 * 60) return fmt::format("{:.0f} min", time_s / 60);
  return fmt::format("{:.1f} h", time_s / 3600);
}

}  // namespace

std::string progress_in_words(const std::string& what, int done, int of, double left_s) {
  const auto percent = of > 0 ? 100LL * done / of : 100;
  auto text = fmt::format("{}: {} of {} ({} %)", what, done, of, percent);
  if (left_s >= 0 && done < of) text += fmt::format(", {} left", time_in_words(left_s));
  return text;
}

Progress::Progress(ShowProgress show)
    : terminal_(::isatty(STDERR_FILENO) == 1), shown_(terminal_ || show == ShowProgress::always) {}

double Progress::left_s(int done, int of) const {
  const auto& first = marks_.front();
  if (done <= first.done) return -1;
  const double passed_s = duration<double>(Clock::now() - first.time).count();
  return passed_s / (done - first.done) * (of - done);
}

void Progress::show(const std::string& what, int done, int of) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  const bool begins = what != what_;
  if (begins) what_ = what, marks_.clear(), marks_.push_back({now, done});
  const auto pause = terminal_ ? milliseconds(200) : milliseconds(3000);
  if (!begins && now - last_ < pause) return;
  // If the output is a file, the first line is printed only after three seconds, so that quick work prints
  // nothing.
  const bool silent = begins && !terminal_ && last_ == Clock::time_point();
  last_ = now;
  marks_.push_back({now, done});
  while (marks_.size() > 2 && now - marks_[1].time > seconds(15)) marks_.pop_front();
  if (silent) return;
  const auto text = progress_in_words(what, done, of, left_s(done, of));
  if (terminal_)
    fmt::print(stderr, "\r{}\x1b[K", text), line_ = true;
  else
    fmt::print(stderr, "{}\n", text);
  std::fflush(stderr);
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (line_) fmt::print(stderr, "\r\x1b[K"), std::fflush(stderr);
  line_ = false;
}

}  // namespace turnpoint::system
