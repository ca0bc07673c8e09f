#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/console_session.hpp"
#include "station/cli/run.hpp"
#include "station/cli/screens.hpp"
#include "station/setup/resume.hpp"

namespace turnpoint::cli {

void add_resume(CommandLine& app, Context& context) {
  auto request = std::make_shared<setup::ResumeRequest>();
  auto* command = app.add_subcommand("resume", "Continue the newest interrupted session");
  command->add_option("--db", request->database, "Database file")->required()->check(existing_file());
  command->add_option("--session", request->session_id,
                      "Session to continue; by default the newest interrupted one");
  command->add_option("--policy", request->policy, "resume | restart | block; otherwise as the protocol says")
      ->check(one_of({"resume", "restart", "block"}));
  command->add_flag("--any-age", request->any_age,
                    "Continue a session although it seems older than its protocol allows, because the clock "
                    "is or was wrong");
  command->add_flag("--headless", request->headless, "No screen");
  add_json(*command, context);
  command->footer("Example: turnpoint resume --db lab.sqlite --policy resume");
  command->callback([request, &context] {
    const auto setup = setup::prepare_resume(*request, context.err);
    if (!setup) {
      if (context.json)
        context.out << "null\n";
      else
        context.out << "Nothing to resume: no session in " << request->database << " was interrupted\n";
      return;
    }
    if (setup->observer.empty() && !request->headless) {
      if (!context.screens) return become_ui(context);
      return show_summary(context, context.screens->session({}, *setup));
    }
    run_without_screen(context, *setup);
  });
}

}  // namespace turnpoint::cli
