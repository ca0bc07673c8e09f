#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/run.hpp"
#include "station/cli/screens.hpp"
#include "station/cli/shared_options.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/view/operator_code.hpp"

namespace turnpoint::cli {

std::shared_ptr<session::StationRequest> add_station_options(Command& command) {
  auto request = std::make_shared<session::StationRequest>();
  command
      .add_option("--protocols", request->protocols,
                  "Folder with protocol files; by default the shipped protocols")
      ->value("FOLDER");
  add_rig(command, request->rig);
  command.add_option("--db", request->database, "Database file; by default one in the user's data folder")
      ->value("FILE");
  command.add_flag("--fullscreen", request->fullscreen, "Fill the screen, even on a desktop computer");
  command.add_flag("--locked", request->locked,
                   "Ask for the operator's code before showing the first page; use this if participants can "
                   "reach the screen");
  return request;
}

void add_station(CommandLine& app, Context& context) {
  auto* command = app.add_subcommand(
      "station",
      "Show the operator's start page, from which sessions are chosen, checked, started and resumed");
  auto request = add_station_options(*command);
  command->footer("Example: turnpoint station --db lab.sqlite");
  command->callback([request, &context] {
    if (request->locked && view::operator_code().is_built_in())
      throw UsageError(
          "station: --locked needs your own operator's code, because the built-in code is public; store one "
          "with: sudo turnpoint operator-code");
    const auto instead = "the station needs a screen; without one, run each session with turnpoint run";
    if (!context.screens) return become_ui(context, instead);
    request->rig = session::rig_or_default(request->rig, context.err);
    if (request->protocols.empty()) request->protocols = session::shipped("protocols");
    if (request->database.empty()) request->database = session::default_database();
    with_screen(instead, [&] { context.screens->station(*request); });
  });
}

}  // namespace turnpoint::cli
