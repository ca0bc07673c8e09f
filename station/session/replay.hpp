#pragma once
#include <vector>

#include "station/session/programs.hpp"
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Makes the director of a session that is to be resumed. It replays the stored trials and then restarts the
/// block or session if `resume_at` says so. Writes nothing to the database. Throws core::Failure if this
/// program would not have presented the stored trials, or if its simulated observer would not have given the
/// stored answers. Such a session cannot be resumed. Throws core::ProgramFailed if a separate program fails;
/// `programs` starts them and must outlive the director.
trial::Director replayed(const Setup& setup, const store::StoredSession& stored, Programs& programs);

/// Returns this program as it was when the session was recorded; null if it took no part.
const core::ProgramRow* as_recorded(const core::ProgramRow& program,
                                    const std::vector<core::EventRow>& events);

}  // namespace turnpoint::session
