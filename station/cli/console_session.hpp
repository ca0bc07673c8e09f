#pragma once
#include "station/cli/command.hpp"
#include "station/session/session.hpp"

namespace turnpoint::cli {

/// Runs a session without a screen, a person's or a simulated observer's, to its end, and shows its summary.
/// The first SIGTERM, SIGINT or SIGHUP ends it by the operator's stop (a simulated one at its next trial), a
/// second of the same kind ends the process at once.
void run_without_screen(Context& context, const session::Setup& setup);

}  // namespace turnpoint::cli
