#pragma once
#include <memory>

#include "station/app/prepare.hpp"
#include "station/cli/command.hpp"

namespace turnpoint::cli {

/// Adds the options of `turnpoint run` to a command; turnpoint-ui takes the same ones.
std::shared_ptr<app::RunRequest> add_run_options(CLI::App& command);

/// Hands the whole command line to turnpoint-ui beside this program; comes back only by an exception.
void become_ui(const Context& context);

/// The summary as text or JSON; a session that was interrupted sets exit status 1.
void show_summary(Context& context, const session::Summary& summary);

}  // namespace turnpoint::cli
