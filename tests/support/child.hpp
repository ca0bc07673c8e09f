#pragma once
#include <string>
#include <vector>

/// Runs a program under test in its own process and collects its output. The destructor kills the process if
/// it still runs.
class Child {
 public:
  /// Starts the program with `environment` ("NAME=value") added to this process's environment. Throws
  /// std::system_error.
  explicit Child(const std::vector<std::string>& command, const std::vector<std::string>& environment = {});
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  void signal(int number) const;
  /// Writes a line to the program's standard input. Throws std::system_error if the program has ended.
  void type(const std::string& line) const;
  /// From now on, nobody reads the program's output, so its pipe fills up.
  void stop_listening();
  /// Waits until the program has printed `text` on standard output or error. Returns false if the program
  /// ends first, or prints nothing for `patience_ms`.
  bool says(const std::string& text, int patience_ms);
  /// Returns true if the program ends within this time. Its output until then is in said().
  bool ends_within(int patience_ms);
  /// Returns true if the program has installed a handler for the signal (according to /proc/PID/status).
  bool handles(int number) const;

  const std::string& said() const { return said_; }
  /// The exit code, or minus the signal that killed the program. Valid only after it has ended.
  int outcome() const { return outcome_; }

 private:
  bool listen(int patience_ms);
  int process_ = -1, descriptor_ = -1, input_ = -1, output_ = -1, outcome_ = 0;
  bool ended_ = false;
  std::string said_;
};
