#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <regex>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/cli/escaped_output.hpp"
#include "station/cli/manual.hpp"
#include "station/core/problem.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::cli {

namespace {

using Add = void (*)(CommandLine&, Context&);
constexpr Add kCommands[] = {
    add_map,           add_field,         add_plan,
    add_synth,         add_trace,         add_run,
    add_resume,        add_export,        add_sessions,
    add_backup,        add_merge,         add_join,
    add_verify,        add_withdraw,      add_annotate,
    add_check,         add_new,           add_protocols,
    add_report,        add_power,         add_doctor,
    add_amplifier_off, add_calibrate,     add_figures,
    add_design,        add_preview,       add_station,
    add_station_name,  add_operator_code, add_self_test,
    add_push,          add_receive,       add_collector_schema,
};

constexpr auto kDescription = "Turnpoint: a psychophysics station for ultrasonic tapered friction displays";

/// Handles two commands that programs call, not people: `turnpoint help --man FOLDER`, which writes the
/// manual pages when the package is built, and `turnpoint help --complete WORD...`, by which a shell
/// completes words. Returns false for any other command line.
bool help_for_tools(const CommandLine& app, const std::vector<std::string>& words, std::ostream& out) {
  if (words.size() < 3 || words[0] != "help") return false;
  if (words[1] == "--man")
    write_manual(app.texts(), std::string(kDescription).substr(std::string("Turnpoint: ").size()), words[2]);
  else if (words[1] == "--complete")
    for (const auto& word : completions(app.texts(), {words.begin() + 2, words.end()})) out << word << "\n";
  else
    return false;
  return true;
}

/// Exit status for an error in the program itself (EX_SOFTWARE of sysexits.h).
constexpr int kSoftwareFault = 70;

/// Hides the password in each address of a server that a message repeats, as in postgresql://user:password@host and
/// "host=lab password=...".
std::string without_passwords(const std::string& message) {
  static const std::regex address(R"((postgres(?:ql)?://[^\s/@:]*:)[^\s/@]*@)");
  static const std::regex word(R"((\bpassword\s*=\s*)('(?:[^'\\]|\\.)*'|[^\s;]+))");
  return std::regex_replace(std::regex_replace(message, address, "$1...@"), word, "$1...");
}

int report(std::ostream& err, const std::exception& error, int code) {
  err << "turnpoint: " << without_passwords(error.what()) << "\n";
  return code;
}

/// Returns the exit status after the output has been written out: `status`, or 1 if a command succeeded but
/// its output did not arrive (full disk, closed pipe).
int status_of_output(std::ostream& out, std::ostream& err, int status) {
  errno = 0;
  out.flush();
  if (out) return status;
  err << "turnpoint: standard output failed"
      << (errno != 0 ? std::string(": ") + std::strerror(errno) : std::string())
      << "; what was printed is incomplete\n";
  return status == 0 ? 1 : status;
}

}  // namespace

void add_json(Command& command, Context& context) {
  command.add_flag("--json", context.json, "Print one JSON document on standard output");
}

int run(int argc, char** argv, std::ostream& raw_out, std::ostream& raw_err, const Screens* screens) {
  system::let_writes_fail();
  EscapedOutput out(raw_out), err(raw_err);
  Context context{out, err, false, 0, {argv, argv + argc + 1}, screens};
  CommandLine app(kDescription, "turnpoint", TURNPOINT_VERSION);
  for (const auto add : kCommands) add(app, context);
  const int status = exit_status(err, [&] {
    if (help_for_tools(app, {argv + 1, argv + argc}, out)) return 0;
    return app.parse(argc, argv, out) ? context.exit_code : 0;
  });
  return status_of_output(out, err, status);
}

int exit_status(std::ostream& err, const std::function<int()>& work) {
  try {
    return work();
  } catch (const core::BadInput& error) {
    err << without_passwords(error.what()) << "\n";
    return 2;
  } catch (const UsageError& error) {
    return report(err, error, 2);
  } catch (const system::RefusedDestination& error) {
    return report(err, error, 2);
  } catch (const std::logic_error& error) {
    report(err, error, kSoftwareFault);
    err << "This is a bug in Turnpoint, not your mistake. Please report it with the command and the files "
           "that you used.\n";
    return kSoftwareFault;
  } catch (const std::exception& error) {
    return report(err, error, 1);
  }
}

}  // namespace turnpoint::cli
