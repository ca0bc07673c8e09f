#include <fmt/format.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/operator_console.hpp"
#include "station/cli/run.hpp"
#include "station/cli/screens.hpp"
#include "station/cli/shared_options.hpp"
#include "station/session/resume.hpp"

namespace turnpoint::cli {

void add_resume(CommandLine& app, Context& context) {
  auto request = std::make_shared<session::ResumeRequest>();
  auto* command = app.add_subcommand("resume", "Continue the newest interrupted session");
  add_database(*command, request->database);
  command->add_option("--session", request->session_id,
                      "Session to continue; by default the newest interrupted one");
  command
      ->add_option("--policy", request->policy,
                   "How to continue: resume | restart | block; by default as the protocol says")
      ->check(one_of({"resume", "restart", "block"}));
  command->add_flag("--any-age", request->any_age,
                    "Continue a session although it seems older than its protocol allows, because the clock "
                    "is or was wrong");
  command->add_option("--despite", request->despite,
                      "Reason to continue although a check of the self-test failed; it is stored");
  command->add_flag("--headless", request->headless, "No screen");
  add_json(*command, context);
  command->footer("Example: turnpoint resume --db lab.sqlite");
  request->self_test = true;
  command->callback([request, &context] {
    const auto setup = session::prepare_resume(*request, context.err);
    if (!setup && !request->session_id.empty())
      throw UsageError(fmt::format(
          "resume: {} has no interrupted session {}; `turnpoint sessions --db {}` lists the sessions",
          request->database, request->session_id, request->database));
    if (!setup) {
      if (context.json)
        context.out << "null\n";
      else
        context.out << "Nothing to resume: no session in " << request->database << " was interrupted\n";
      return;
    }
    if (setup->observer.empty() && !request->headless) {
      const auto instead = "use --headless if the rig has buttons to answer with";
      if (!context.screens) return become_ui(context, instead);
      return show_summary(context,
                          with_screen(instead, [&] { return context.screens->session({}, *setup); }));
    }
    run_without_screen(context, *setup);
  });
}

}  // namespace turnpoint::cli
