#pragma once
#include <memory>
#include <string>
#include <vector>

#include "station/observer/observer.hpp"
#include "station/procedure/program.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/text/problem.hpp"

namespace turnpoint::programs {

/// Starts the separate programs of one session, and remembers which they were. The procedures and observers
/// that it makes must not outlive it.
class Programs final : public procedure::Programs {
 public:
  /// `protocol_path` is the path of the protocol file, from whose folder the paths of programs are seen.
  explicit Programs(std::string protocol_path) : protocol_path_(std::move(protocol_path)) {}
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;

  std::unique_ptr<procedure::Procedure> procedure(const procedure::Spec& spec,
                                                  const random::Key& key) override;
  /// Returns the observer that the argument of `--observer` names: the built-in one (`sim...`), or a program
  /// (`program:...`). Throws terms::UsageError.
  observer::Respondent respondent(const std::string& observer);

  /// The programs that were started since the last call of take_started(), each once.
  const std::vector<records::ProgramRow>& started() const { return started_; }
  std::vector<records::ProgramRow> take_started();

 private:
  void add_started(const records::ProgramRow& program);

  std::string protocol_path_;
  std::vector<records::ProgramRow> started_;
};

/// Returns the absolute path of a program, as seen from the folder of the protocol file.
std::string path_of(const std::string& program, const std::string& protocol_path);

/// True if the argument of `--observer` names a program (`program:...`).
bool is_program(const std::string& observer);
/// Returns the argument of `--observer` with the path of its program made absolute, so that the session can
/// be resumed from another folder. Throws terms::UsageError if the program cannot be run. Returns other
/// observers as they are.
std::string located(const std::string& observer);

/// Starts each program of the protocol, waits for its greeting and its first level, and ends it again.
/// Returns the problems, at the places of the programs in the protocol.
std::vector<text::Problem> problems_of(const protocol::Protocol& protocol);

}  // namespace turnpoint::programs
