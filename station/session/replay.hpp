#pragma once
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Makes the director of a session that is to be resumed. It replays the stored trials and then restarts the
/// block or session if `resume_at` says so. Writes nothing to the database. Throws std::runtime_error if this
/// program would not have presented the stored trials, or if its simulated observer would not have given the
/// stored answers. Such a session cannot be resumed.
trial::Director replayed(const Setup& setup, const store::StoredSession& stored);

}  // namespace turnpoint::session
