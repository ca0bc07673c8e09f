#pragma once
#include <memory>
#include <string>

#include "station/cli/command.hpp"
#include "station/cli/screens.hpp"
#include "station/session/prepare.hpp"

namespace turnpoint::cli {

/// Adds the options of `turnpoint run` to a command. turnpoint-ui accepts the same options.
std::shared_ptr<session::RunRequest> add_run_options(Command& command);

/// Adds the options of `turnpoint station`. amplifier-off accepts them too, so that it can be called with the
/// command line of the station.
std::shared_ptr<session::StationRequest> add_station_options(Command& command);

/// Replaces this process by the program turnpoint-ui in the same folder, with the same command line. Never
/// returns; throws if turnpoint-ui cannot be started. `instead` is advice on what to do without a screen.
void become_ui(const Context& context, const std::string& instead);

/// Calls `show`, which opens a window. If there is no screen, the UsageError contains the advice `instead`.
template <class Show>
auto with_screen(const std::string& instead, Show show) {
  try {
    return show();
  } catch (const NoScreen& error) {
    throw UsageError(error.what() + ("; " + instead));
  }
}

/// Prints the summary as JSON, or as text with the command that continues an interrupted session. An
/// interrupted session sets exit status 1. `resume_options` are further options for that command, such as "
/// --headless".
void show_summary(Context& context, const session::Summary& summary, const std::string& resume_options = "");

}  // namespace turnpoint::cli
