#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/texts.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/session.hpp"
#include "station/store/session_log.hpp"
#include "station/trial/earlier_trials.hpp"

namespace turnpoint::session {

/// Describes in English why a session may not begin yet, for the command line and the log.
std::string describe(const EarlySession& early);

/// A session that is possible, except that it would begin too early.
class TooEarly : public core::BadInput {
 public:
  TooEarly(core::Problem problem, EarlySession early)
      : BadInput({std::move(problem)}), early_(std::move(early)) {}
  const EarlySession& early() const { return early_; }

 private:
  EarlySession early_;
};

/// Returns the participant's place in the counterbalancing, and the number of the planned session, of a
/// stored session.
protocol::Visit visit_of(const store::SessionRecord& session);

/// The planned session that a participant does next, or the reason why it cannot begin now.
struct NextSession {
  std::optional<int> number;  ///< empty if the protocol plans no sessions
  core::Phrase problem;       ///< why the session cannot begin; empty if it can
  core::Phrase allowed;       ///< what is possible instead
  /// set if the problem is only that too few days have passed, so that a reason overrules it
  std::optional<EarlySession> too_early;
  /// why it would be refused if the operator had not given a reason
  std::string overruled;
};

/// Decides which session comes next. `earlier` are the participant's sessions with this protocol, and `today`
/// is a date such as 2026-11-24. Only sessions of the same run mode count. Simulated sessions need not keep
/// the protocol's minimum number of days between sessions.
NextSession next_session(const Setup& setup, const std::vector<store::SessionRecord>& earlier,
                         const std::string& today);

/// Returns the trials of the participant's earlier planned sessions, for procedures of the protocol that
/// continue. `session` is the session that is about to begin or was begun: its participant, station, run
/// mode, planned session and session_index count. Throws core::UsageError if an earlier session was made
/// with another version of the protocol, and std::runtime_error if a procedure could not have presented its
/// trials.
procedure::EarlierTrials earlier_trials(const std::string& database, const protocol::Protocol& protocol,
                                        const store::SessionRecord& session);

/// The same for the session of this setup, which has not begun.
procedure::EarlierTrials earlier_trials(const Setup& setup, const NextSession& next);

/// The next session of this setup, for the sessions in its database and the current date.
NextSession next_session(const Setup& setup);

/// The current time in the station's time zone, in the form that is stored (ISO 8601).
std::string local_time();

}  // namespace turnpoint::session
