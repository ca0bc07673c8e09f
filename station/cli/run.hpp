#pragma once
#include <memory>
#include <string>

#include "station/app/prepare.hpp"
#include "station/app/station_request.hpp"
#include "station/cli/command.hpp"

namespace turnpoint::cli {

/// Adds the options of `turnpoint run` to a command; turnpoint-ui takes the same ones.
std::shared_ptr<app::RunRequest> add_run_options(Command& command);

/// Adds the options of `turnpoint station`; amplifier-off takes the same ones.
std::shared_ptr<app::StationRequest> add_station_options(Command& command);

/// Hands the whole command line to turnpoint-ui beside this program; comes back only by an exception.
void become_ui(const Context& context);

/// The summary as text, with the command that goes on with an interrupted session, or as JSON. A session that
/// was interrupted sets exit status 1. `resume_options`: what that command needs besides (" --headless").
void show_summary(Context& context, const session::Summary& summary, const std::string& resume_options = "");

}  // namespace turnpoint::cli
