#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/report/study.hpp"

namespace turnpoint::view {

/// Which sessions belong to a study.
struct StudyChoice {
  std::vector<std::string> databases;
  std::vector<std::string> names;  ///< names of the databases, as the report shows them
  std::string protocol_id;         ///< "" if the databases have sessions of one protocol only
  /// version of the protocol, or the beginning of the SHA-256 of its text; "" if all sessions have the same
  std::string protocol_version;
  std::string mode;  ///< live, pilot or simulated; "" if all sessions have the same
  std::string task;  ///< name of the task to report; "" if the protocol has one
};

/// Called once for each participant, with the trials of all sessions of this participant.
using StudySink = std::function<void(const report::StudyPerson& person, const report::SessionData& data)>;
/// Called before each participant with the number of participants that are done and their total number.
/// Returns false to stop.
using StudyProgress = std::function<bool(int done, int of)>;

/// Analyses all sessions of one protocol that have trials, from all the databases. Only the trials of one
/// participant are in memory at a time. A session that is in several files counts once. The same code at two
/// stations stands for two people, who are called CODE@STATION. Throws core::UsageError if the sessions
/// differ in protocol, text or mode and the choice does not say which to use; throws StoreError if there are
/// none.
report::Study study_data(const StudyChoice& choice, const StudySink& sink, const StudyProgress& progress);

}  // namespace turnpoint::view
