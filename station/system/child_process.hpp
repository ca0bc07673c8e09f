#pragma once
#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "station/core/file_descriptor.hpp"

namespace turnpoint::system {

/// A separate program that exchanges lines of text on its standard streams. It gets as few rights as
/// possible: no real-time priority, no locked memory, no new privileges, none of this program's files, a
/// lower priority, and an environment with only PATH, HOME and LANG. It is the first to be ended if memory
/// runs out. The kernel kills it when the thread that started it ends, however that happens. Use it from that
/// thread. No function waits except wait() and the destructor.
class ChildProcess {
 public:
  /// Starts this executable file, in its own folder. Throws std::system_error that names the file.
  explicit ChildProcess(const std::string& file);
  /// Closes the program's standard input, at which it should end. Sends SIGTERM if it has not ended within a
  /// tenth of a second, and SIGKILL after another tenth.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a line, to which the line feed is added. What the program does not take at once is sent by later
  /// calls of line() and wait().
  void send(std::string_view line);
  /// Returns the next complete line that the program has written, without its line feed.
  std::optional<std::string> line();
  /// Waits until the program has written something or ended, but not beyond this time of monotonic_ns().
  void wait(std::int64_t until_ns);

  /// Number of bytes that the program has written since its last complete line.
  std::size_t unfinished() const { return out_.size(); }
  /// True if the program can write no more, because it has ended or closed its standard output.
  bool silent() const { return !from_.is_open(); }
  /// Says how the program ended: "ended with status 1" or "was killed by signal 9". Returns "closed its
  /// standard output" if it still runs.
  std::string how_it_ended();
  /// The last line that the program wrote to its standard error; "" if there is none.
  std::string complaint() const;

 private:
  void exchange();
  void write_waiting();
  bool ended();
  bool ends_within(std::int64_t ns);

  pid_t id_ = -1;
  bool reaped_ = false;
  int status_ = 0;
  core::FileDescriptor to_, from_, errors_;
  std::string waiting_, out_, said_;
};

}  // namespace turnpoint::system
