#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "station/app/prepare.hpp"

namespace turnpoint::cli {

/// Runs a session on a screen, asking there for what the request leaves open (language, participant's code).
/// Only turnpoint-ui has one; turnpoint hands over to turnpoint-ui.
/// A session that is already prepared (one that goes on) comes whole, and its request is not looked at.
using Screen = std::function<session::Summary(app::RunRequest, std::optional<session::Setup>)>;

/// What every sub-command gets: where its document and its messages go, and whether JSON was asked for.
struct Context {
  std::ostream& out;  ///< the result: text for people, or one JSON document
  std::ostream& err;  ///< messages
  bool json = false;
  int exit_code = 0;             ///< what a command sets when it is neither 0 nor an exception
  std::vector<char*> arguments;  ///< the command line as given, null at the end, for handing over
  Screen screen = {};            ///< empty in the program without one
};

/// Wrong usage that the option parser could not see: exit 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Each adds one sub-command: its options, an example in the footer, and the callback that does it. One file
/// each; the table in commands.cpp lists them.
void add_map(CLI::App& app, Context& context);
void add_field(CLI::App& app, Context& context);
void add_plan(CLI::App& app, Context& context);
void add_synth(CLI::App& app, Context& context);
void add_trace(CLI::App& app, Context& context);
void add_run(CLI::App& app, Context& context);
void add_doctor(CLI::App& app, Context& context);
void add_resume(CLI::App& app, Context& context);
void add_export(CLI::App& app, Context& context);
void add_sessions(CLI::App& app, Context& context);
void add_backup(CLI::App& app, Context& context);
void add_merge(CLI::App& app, Context& context);
void add_withdraw(CLI::App& app, Context& context);
void add_annotate(CLI::App& app, Context& context);
void add_check(CLI::App& app, Context& context);
void add_new(CLI::App& app, Context& context);
void add_protocols(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);
void add_figures(CLI::App& app, Context& context);
void add_power(CLI::App& app, Context& context);
void add_bench(CLI::App& app, Context& context);

/// Adds `--json` to a sub-command.
void add_json(CLI::App& command, Context& context);

/// Parses and does what the command line says. Returns the exit status: 0 done, 1 failed at run time, 2 bad
/// input or usage. The only catch-all of the program.
int run(int argc, char** argv, std::ostream& out, std::ostream& err, const Screen& screen = {});

}  // namespace turnpoint::cli
