#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/report/study.hpp"

namespace turnpoint::desk {

/// Which sessions belong to a study.
struct StudyChoice {
  std::vector<std::string> databases;
  std::vector<std::string> names;  ///< of the databases, for the report
  std::string protocol_id;         ///< "" if the databases have sessions of one protocol only
  std::string protocol_version;  ///< version, or the beginning of the SHA-256 of its text; "" if there is one
  std::string mode;              ///< live, pilot or simulated; "" if all sessions have the same
};

/// Called after each participant, with the trials of all the participant's sessions.
using StudySink = std::function<void(const report::StudyPerson& person, const report::SessionData& data)>;
/// Called before each participant: how many are done, of how many. Returns false to stop.
using StudyProgress = std::function<bool(int done, int of)>;

/// Analyses all sessions of one protocol with trials, in all the databases. The trials of only one
/// participant are in memory at a time. A session that is in several files counts once. The same code at two
/// stations is two people, called CODE@STATION. Throws terms::UsageError if the sessions have different
/// protocols, texts or modes and the choice does not say which; StoreError if there are none.
report::Study study_data(const StudyChoice& choice, const StudySink& sink, const StudyProgress& progress);

}  // namespace turnpoint::desk
