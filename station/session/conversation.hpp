#pragma once
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "station/core/usage_error.hpp"
#include "station/system/child_process.hpp"

namespace turnpoint::session {

using Json = nlohmann::json;

/// A program that an option of the command line names: `program:FILE[,limit_s=S][,KEY=VALUE]...`.
struct ProgramChoice {
  std::string path;
  double limit_s = 2;
  Json settings = Json::object();  ///< the other keys, which are numbers if they look like numbers
};

/// Reads the value of an option. `option` is the name of the option, for messages. Throws core::UsageError.
ProgramChoice parse_program(const std::string& option, const std::string& text);

/// The same, and also throws core::UsageError if there is no such program, or if it cannot be run.
ProgramChoice existing_program(const std::string& option, const std::string& text);

/// Name of the messages and their version. A program must greet with the same one.
inline constexpr const char* kFormat = "turnpoint-program/1";

/// A program as it was started: its file, and what it says about itself.
struct Identity {
  std::string path, sha256, name, version;
};

/// Starts a separate program and exchanges messages with it: one JSON object a line. protocols/programs.md
/// lists the messages. All functions throw core::ProgramFailed, with the name of the file, if the program
/// cannot be started, dies, is late, or does not write the JSON object that is expected. Use it from one
/// thread.
class Conversation {
 public:
  /// Starts this file and sends it the greeting, with the program's role and everything that it has to know.
  /// `limit_s` is the longest time that it may take for each reply; for its greeting it has 10 s, or more.
  Conversation(const std::string& path, double limit_s, Json greeting);

  /// Sends a message to which there is no reply.
  void tell(const Json& message);
  /// Sends a message to which there will be a reply, and numbers it ("id"). More may be sent before the reply
  /// is here.
  void ask(Json message);
  /// Returns the next reply if it is here.
  std::optional<Json> reply();
  /// Waits until the program has written something, or is late.
  void wait();
  /// Waits for the next reply.
  Json wait_for_reply();
  /// Number of replies that are still to come.
  int awaited() const { return asked_ - replied_; }
  /// The program's identity; empty until it has greeted.
  const std::optional<Identity>& identity() const { return identity_; }

  /// Says that the program failed: "FILE: " and `what`.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::optional<Json> next_message();
  void greet(const Json& message);
  std::int64_t due_ns() const;

  Identity file_;
  std::int64_t limit_ns_;
  std::unique_ptr<system::ChildProcess> child_;
  std::optional<Identity> identity_;
  int asked_ = 0, replied_ = 0;
  bool greeting_ = true;       ///< the greeting has not been answered
  std::int64_t since_ns_ = 0;  ///< when the program got the oldest question that it has not answered
};

/// Returns a member of a reply. Throws core::ProgramFailed if it is missing or has another type.
double number_in(const Json& reply, const char* key, const Conversation& from);
std::string text_in(const Json& reply, const char* key, const Conversation& from);

/// Returns why this file cannot be run as a program; "" if it can.
std::string problem_of(const std::string& path);

}  // namespace turnpoint::session
