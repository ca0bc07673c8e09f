#pragma once
#include <string>
#include <vector>

/// A program under test in a process of its own, with what it says; killed where it still runs at the end.
class Child {
 public:
  /// Starts it, `environment` ("NAME=value") added to this process's. Throws std::system_error.
  explicit Child(const std::vector<std::string>& command, const std::vector<std::string>& environment = {});
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  void signal(int number) const;
  /// A line for its standard input. Throws std::system_error where it has ended.
  void type(const std::string& line) const;
  /// From now on what it says goes to a pipe that nobody reads.
  void stop_listening();
  /// True once it has said `text` on standard output or error; false where it ends, or says nothing for
  /// `patience_ms`, before.
  bool says(const std::string& text, int patience_ms);
  /// True where it has ended within so long; what it said until then is in said().
  bool ends_within(int patience_ms);
  /// True while it has a handler of its own for the signal (/proc/PID/status).
  bool handles(int number) const;

  const std::string& said() const { return said_; }
  /// The exit code, or minus the signal that killed it; only after it has ended.
  int outcome() const { return outcome_; }

 private:
  bool listen(int patience_ms);
  int process_ = -1, descriptor_ = -1, input_ = -1, output_ = -1, outcome_ = 0;
  bool ended_ = false;
  std::string said_;
};
