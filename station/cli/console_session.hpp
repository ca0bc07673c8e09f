#pragma once
#include "station/cli/command.hpp"
#include "station/session/session.hpp"

namespace turnpoint::cli {

/// Runs a session without a screen, with a person or a simulated observer, to its end and prints its summary.
/// The first SIGTERM, SIGINT or SIGHUP ends the session like the operator's stop (a simulated session at its
/// next trial). A second signal of the same kind ends the process at once.
void run_without_screen(Context& context, const session::Setup& setup);

}  // namespace turnpoint::cli
