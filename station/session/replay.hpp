#pragma once
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// The director of a session that is being resumed, where its stored trials leave it and as `resume_at` wants
/// it. Writes nothing. Throws std::runtime_error where this program would not have presented the stored
/// trials, or its simulated observer not given the stored answers: the session cannot be resumed with it.
trial::Director replayed(const Setup& setup, const store::StoredSession& stored);

}  // namespace turnpoint::session
