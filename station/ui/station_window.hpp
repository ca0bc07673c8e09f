#pragma once
#include <optional>

#include "station/app/prepare.hpp"
#include "station/session/session.hpp"

namespace turnpoint::ui {

/// Runs one session on the screen: asks for what the request leaves open (language, participant's code),
/// shows the session's pages and takes its inputs, and returns when the window is closed after the end. The
/// session runs on a thread of its own; what it throws is shown as a fault page and thrown again from here.
/// Throws text::BadInput for files that do not fit, and std::runtime_error where there is no screen to open.
/// Once per process, since it makes the application object.
/// `prepared` is a session that goes on: it asks nothing, and `request` is not used.
session::Summary run_on_screen(app::RunRequest request, std::optional<session::Setup> prepared);

}  // namespace turnpoint::ui
