#pragma once
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Makes the director of a session to be resumed, in the state after its stored trials and adjusted as
/// `resume_at` says. Writes nothing. Throws std::runtime_error if this program would not have presented the
/// stored trials, or if its simulated observer would not have given the stored answers; the session can then
/// not be resumed.
trial::Director replayed(const Setup& setup, const store::StoredSession& stored);

}  // namespace turnpoint::session
