#include <memory>
#include <string>

#include "station/cli/command.hpp"
#include "station/cli/run.hpp"
#include "station/cli/screens.hpp"
#include "station/cli/shared_options.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"

namespace turnpoint::cli {

namespace design_command {

constexpr const char* without_screen =
    "without a screen, make a file with turnpoint new, and change it with a text editor";

}  // namespace design_command

void add_design(CommandLine& app, Context& context) {
  using namespace design_command;
  auto request = std::make_shared<DesignRequest>();
  auto* command = app.add_subcommand("design", "Make or change a protocol file on the screen, in forms");
  command
      ->add_option("file", request->file,
                   "The protocol file to change; if there is none, the screen asks what you want to measure")
      ->value("FILE");
  add_rig(*command, request->rig);
  command->footer("Example: turnpoint design my-study.toml");
  command->callback([request, &context] {
    if (!context.screens) return become_ui(context, without_screen);
    request->rig = session::rig_or_default(request->rig, context.err);
    session::calibrated_rig(request->rig, "",
                            context.err);  // refuses an unreadable rig before a window opens
    with_screen(without_screen, [&] { context.screens->design(*request); });
  });
}

}  // namespace turnpoint::cli
