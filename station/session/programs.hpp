#pragma once
#include <memory>
#include <string>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/records.hpp"
#include "station/procedure/program.hpp"
#include "station/protocol/protocol.hpp"
#include "station/simulation/observer.hpp"

namespace turnpoint::session {

/// Starts the separate programs of one session, and remembers which they were. The procedures and observers
/// that it makes must not outlive it.
class Programs final : public procedure::Programs {
 public:
  /// `protocol_path` is the path of the protocol file, from whose folder the paths of programs are seen.
  explicit Programs(std::string protocol_path) : protocol_path_(std::move(protocol_path)) {}
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;

  std::unique_ptr<procedure::Procedure> procedure(const procedure::Spec& spec,
                                                  const core::DrawKey& key) override;
  /// Returns the observer that the argument of `--observer` names: the built-in one (`sim...`), or a program
  /// (`program:...`). Throws core::UsageError.
  simulation::Respondent respondent(const std::string& observer);

  /// The programs that were started since the last call of take_started(), each once.
  const std::vector<core::ProgramRow>& started() const { return started_; }
  std::vector<core::ProgramRow> take_started();

 private:
  void add_started(const core::ProgramRow& program);

  std::string protocol_path_;
  std::vector<core::ProgramRow> started_;
};

/// Returns the absolute path of a program, as seen from the folder of the protocol file.
std::string path_of(const std::string& program, const std::string& protocol_path);

/// True if the argument of `--observer` names a program (`program:...`).
bool is_program(const std::string& observer);
/// Returns the argument of `--observer` with the path of its program made absolute, so that the session can
/// be resumed from another folder. Throws core::UsageError if the program cannot be run. Returns other
/// observers as they are.
std::string located(const std::string& observer);

/// Starts each program of the protocol, waits for its greeting and its first level, and ends it again.
/// Returns the problems, at the places of the programs in the protocol.
std::vector<core::Problem> problems_of(const protocol::Protocol& protocol);

}  // namespace turnpoint::session
