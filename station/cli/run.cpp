#include "station/cli/run.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "station/cli/json.hpp"
#include "station/cli/operator_console.hpp"
#include "station/cli/screens.hpp"
#include "station/cli/shared_options.hpp"
#include "station/core/number.hpp"
#include "station/session/places.hpp"
#include "station/store/read.hpp"

namespace turnpoint::cli {

void become_ui(const Context& context, const std::string& instead) {
  const auto self = std::filesystem::read_symlink("/proc/self/exe");
  const auto ui = (self.parent_path() / "turnpoint-ui").string();
  auto arguments = context.arguments;
  ::execve(ui.c_str(), arguments.data(), environ);
  throw std::system_error(errno, std::generic_category(), "cannot start " + ui + " (" + instead + ")");
}

namespace run_command {

Json to_json(const session::Summary& summary) {
  Json estimates = Json::array();
  for (const auto& e : summary.estimates)
    estimates.push_back({{"procedure", e.procedure},
                         {"parameter", e.parameter},
                         {"mean", json_number(e.mean)},
                         {"sd", json_number(e.sd)},
                         {"interval", json_interval(e.interval)},
                         {"basis", e.basis.empty() ? Json(nullptr) : Json(e.basis)}});
  Json early_ends = Json::array();
  for (const auto& end : summary.early_ends) early_ends.push_back(core::say(end, "en"));
  return {{"session_id", summary.session_id},
          {"early_ends", early_ends},
          {"participant", summary.participant},
          {"protocol", summary.protocol_id},
          {"database", summary.database},
          {"run_mode", summary.run_mode},
          {"status", core::name(summary.status)},
          {"reason", summary.reason},
          {"seed", summary.seed},
          {"blocks", summary.blocks},
          {"trials", summary.trials},
          {"answered", summary.answered},
          {"timeouts", summary.timeouts},
          {"anticipations", summary.anticipations},
          {"voided", summary.voided},
          {"accuracy", json_number(summary.accuracy)},
          {"points", json_number(summary.points)},
          {"duration_s", json_number(summary.duration_s)},
          {"xruns", summary.xruns},
          {"triggers", summary.triggers},
          {"triggers_missed", summary.triggers_missed},
          {"triggers_extra", summary.triggers_extra},
          {"stretched_s", json_number(summary.stretched_s)},
          {"realtime_rights", summary.realtime_rights},
          {"checksum", summary.checksum},
          {"estimates", estimates}};
}

void print_summary(std::ostream& out, const session::Summary& s) {
  using core::number;
  fmt::print(out, "Session {} ({}, {}): {}{}\n", s.session_id, s.protocol_id, s.run_mode,
             core::name(s.status), s.reason.empty() ? "" : ": " + s.reason);
  fmt::print(out, "  participant {}, seed {}, {} {}, {} trials in {} min\n", s.participant, s.seed, s.blocks,
             s.blocks == 1 ? "block" : "blocks", s.trials, number(s.duration_s / 60, 3));
  fmt::print(out, "  {} answered, {} too late, {} too early, {} void\n", s.answered, s.timeouts,
             s.anticipations, s.voided);
  if (s.accuracy) fmt::print(out, "  {} % of the scored answers right\n", number(100 * *s.accuracy, 3));
  if (s.points) fmt::print(out, "  {} points\n", number(*s.points, 6));
  for (const auto& e : s.estimates)
    fmt::print(out, "  {}: {} {}\n", e.procedure, e.parameter, trial::in_words(e));
  if (s.triggers_missed + s.triggers_extra > 0)
    fmt::print(out, "  {} of {} trigger codes were missed; {} were read back that had not been sent\n",
               s.triggers_missed, s.triggers, s.triggers_extra);
  if (s.stretched_s > 0)
    fmt::print(out, "  pauses were lengthened by {} s in total to keep within the rig's limits\n",
               number(s.stretched_s, 3));
  fmt::print(out, "  real-time rights: {}\n", s.realtime_rights);
  fmt::print(out, "  database {}\n", s.database);
  fmt::print(out, "  checksum {}\n", s.checksum);
}

/// Prints the command that continues the session. Prints nothing if the session has no trial, because it
/// cannot be resumed then.
void print_how_to_resume(std::ostream& out, const session::Summary& s, const std::string& options) {
  if (store::interrupted_session(s.database, s.session_id))
    fmt::print(out, "  to continue: turnpoint resume --db {} --session {}{}\n", s.database, s.session_id,
               options);
}

}  // namespace run_command

void show_summary(Context& context, const session::Summary& summary, const std::string& resume_options) {
  using namespace run_command;
  const bool interrupted = summary.status == core::SessionStatus::interrupted;
  if (interrupted) context.exit_code = 1;
  if (context.json) {
    print_json(context.out, to_json(summary));
    return;
  }
  print_summary(context.out, summary);
  if (interrupted) print_how_to_resume(context.out, summary, resume_options);
}

namespace run_command {

void add_conditions(Command& command, session::RunRequest& request) {
  auto& conditions = request.conditions;
  command.add_flag(
      "--self-test", request.self_test,
      "Run the self-test first, although the observer is simulated; with a person it always runs");
  command.add_option("--despite", request.despite,
                     "Reason to continue although a check of the self-test failed; it is stored");
  command.add_option("--humidity", conditions.humidity_percent, "Relative humidity of the room, in %")
      ->check(between(0, 100));
  command
      .add_option("--temperature", conditions.room_temperature_C,
                  "Temperature of the room, in degrees Celsius")
      ->check(between(-20, 60));
  command.add_option("--cleaned", request.cleaned, "Whether the surface was cleaned just before the session")
      ->check(one_of({"yes", "no"}));
  command.add_option("--finger", conditions.finger, "Hand and finger on the surface, such as right-index")
      ->check(one_of({core::fingers.begin(), core::fingers.end()}));
  command
      .add_option("--skin-moisture", conditions.skin_moisture,
                  "Moisture of the fingertip, as a moisture meter reads it, in the meter's unit")
      ->check(between(0, 1000));
}

}  // namespace run_command

std::shared_ptr<session::RunRequest> add_run_options(Command& command) {
  auto request = std::make_shared<session::RunRequest>();
  add_protocol(command, request->protocol);
  add_rig(command, request->rig);
  command.add_option("--participant", request->participant,
                     "Participant code (never a name); if it is left out, the screen asks for it");
  add_new_database(command, request->database, "Database file; created if missing");
  command.add_option("--mode", request->mode, "live | pilot")
      ->capture_default_str()
      ->check(one_of({"live", "pilot"}));
  command.add_option("--language", request->language,
                     "One of the protocol's languages; by default the first one");
  command.add_option(
      "--observer", request->observer,
      "sim[:threshold=...,slope=...,lapse=...,bias=...,criterion=...,bound=...]: a simulated observer "
      "answers; protocols/check-and-power.md lists all keys; or program:FILE[,KEY=VALUE]...: a separate program "
      "answers; protocols/programs.md");
  command.add_option("--seed", request->seed, "Seed for all random numbers, 0 to 2^53")
      ->check(range(0, 9007199254740992));
  command.add_option(
      "--consent", request->consent_version,
      "Version of the consent form; the screen asks the participant to confirm having signed it");
  command.add_flag("--headless", request->headless, "No screen");
  command.add_flag("--fullscreen", request->fullscreen, "Fill the screen, even on a desktop computer");
  command.add_flag(
      "--buttons-only", request->buttons_only,
      "Run without a screen: a person answers with the rig's buttons, and the operator types commands");
  command
      .add_option("--calibration", request->calibration,
                  "Calibration file; by default the newest one beside the rig file")
      ->value("FILE");
  command
      .add_option("--planned-session", request->planned_session,
                  "Which of the protocol's planned sessions to run; by default the participant's next one")
      ->check(range(1, 100));
  command.add_option("--early", request->early,
                     "Reason to begin before the least number of days between sessions has passed; it is "
                     "stored");
  run_command::add_conditions(command, *request);
  return request;
}

void add_run(CommandLine& app, Context& context) {
  using namespace run_command;
  auto* command = app.add_subcommand("run", "Run a session");
  auto request = add_run_options(*command);
  add_json(*command, context);
  command->footer(
      "Example: turnpoint run demo --participant P01 --db lab.sqlite --observer sim\n"
      "Without --observer a person answers, on the screen or, with --buttons-only, by the rig's buttons.\n"
      "If there is no screen, Ctrl-C or SIGTERM ends the session cleanly, so that it can be resumed; a "
      "second "
      "one kills it.");
  command->callback([request, &context] {
    const bool person = request->observer.empty();
    request->self_test = request->self_test || person;
    if (person && request->headless && !request->buttons_only)
      throw UsageError(
          "run: without a screen nobody can answer; use --observer sim for a simulated observer, or "
          "--buttons-only");
    const bool on_screen = person && !request->buttons_only;
    const auto instead = "without a screen use --observer sim or --buttons-only";
    if (on_screen && !context.screens) return become_ui(context, instead);
    if (!on_screen && request->participant.empty())
      throw UsageError("run: --participant is missing; only a screen can ask for it");
    request->rig = session::rig_or_default(request->rig, context.err);
    if (on_screen)
      return show_summary(
          context, with_screen(instead, [&] { return context.screens->session(*request, std::nullopt); }));
    run_without_screen(context, session::prepare(*request));
  });
}

}  // namespace turnpoint::cli
