#pragma once
#include <iosfwd>
#include <stdexcept>
#include <vector>

#include "station/cli/command_line.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::cli {

struct Screens;  // defined in screens.hpp

/// What every sub-command gets: the streams for its result and its messages, and the common options.
struct Context {
  std::ostream& out;  ///< the result: text for people, or one JSON document
  std::ostream& err;  ///< warnings, errors and progress
  bool json = false;
  /// the exit status; set by a command that ends without an exception but must not return 0
  int exit_code = 0;
  /// the command line as given; its last element is null, as execv() requires
  std::vector<char*> arguments;
  const Screens* screens = nullptr;  ///< how to show windows; null in a program without a screen
};

using core::UsageError;

/// Calls `work`, which passes numbers from the command line to the physics library without checking them. If
/// the library refuses a number, throws a UsageError.
template <class Work>
auto with_users_numbers(Work work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  } catch (const std::domain_error& error) {
    throw UsageError(error.what());
  }
}

/// Each of these functions adds one sub-command: its options, an example in the footer, and the callback that
/// runs it. Each is in a file of its own. The table in commands.cpp lists them all.
void add_map(CommandLine& app, Context& context);
void add_field(CommandLine& app, Context& context);
void add_plan(CommandLine& app, Context& context);
void add_synth(CommandLine& app, Context& context);
void add_trace(CommandLine& app, Context& context);
void add_run(CommandLine& app, Context& context);
void add_amplifier_off(CommandLine& app, Context& context);
void add_doctor(CommandLine& app, Context& context);
void add_self_test(CommandLine& app, Context& context);
void add_calibrate(CommandLine& app, Context& context);
void add_resume(CommandLine& app, Context& context);
void add_export(CommandLine& app, Context& context);
void add_sessions(CommandLine& app, Context& context);
void add_backup(CommandLine& app, Context& context);
void add_merge(CommandLine& app, Context& context);
void add_verify(CommandLine& app, Context& context);
void add_join(CommandLine& app, Context& context);
void add_withdraw(CommandLine& app, Context& context);
void add_annotate(CommandLine& app, Context& context);
void add_check(CommandLine& app, Context& context);
void add_new(CommandLine& app, Context& context);
void add_protocols(CommandLine& app, Context& context);
void add_report(CommandLine& app, Context& context);
void add_figures(CommandLine& app, Context& context);
void add_power(CommandLine& app, Context& context);
void add_design(CommandLine& app, Context& context);
void add_preview(CommandLine& app, Context& context);
void add_station(CommandLine& app, Context& context);
void add_station_name(CommandLine& app, Context& context);
void add_push(CommandLine& app, Context& context);
void add_receive(CommandLine& app, Context& context);
void add_collector_schema(CommandLine& app, Context& context);
void add_operator_code(CommandLine& app, Context& context);

void add_json(Command& command, Context& context);

/// Runs `work` and explains any exception on `err`. Returns the exit status: 0 done, 1 failed at run time, 2
/// bad input or usage, 70 an error in the program itself.
int exit_status(std::ostream& err, const std::function<int()>& work);

/// Parses the command line, runs the command and returns the exit status.
int run(int argc, char** argv, std::ostream& out, std::ostream& err, const Screens* screens = nullptr);

}  // namespace turnpoint::cli
