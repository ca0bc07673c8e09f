#include "station/store/withdraw.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <iostream>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"

namespace turnpoint::cli {

namespace withdraw_command {

struct Options {
  std::string database;
  store::WithdrawOptions withdraw;
  bool dry_run = false, yes = false;
};

Json to_json(const store::Withdrawal& gone, const Options& options) {
  Json sessions = Json::array();
  for (const auto& s : gone.sessions)
    sessions.push_back({{"session_id", s.session_id},
                        {"participant", s.start.participant},
                        {"station_id", s.start.station_id},
                        {"protocol_id", s.start.protocol_id},
                        {"started", s.start.started_local},
                        {"trials", s.trials}});
  Json codes = Json::array();
  for (const auto& bearer : gone.bearers) codes.push_back(store::full_name(bearer));
  return {{"participant", gone.participant},
          {"dry_run", options.dry_run},
          {"sessions", sessions},
          {"codes", codes},
          {"trials", gone.trials},
          {"tones", gone.tones},
          {"events", gone.events},
          {"annotations", gone.annotations},
          {"removed_copies", gone.removed_copies},
          {"remaining_copies", gone.remaining_copies}};
}

/// Prints the contents of a withdrawal. `verb` is "deleted" or "would be deleted".
void print(std::ostream& out, const store::Withdrawal& gone, const std::string& verb) {
  for (const auto& s : gone.sessions)
    fmt::print(out, "{}: session {} of {} at {}, {} of {}, {} trials\n", verb, s.session_id,
               s.start.participant, s.start.station_id, s.start.protocol_id, s.start.started_local, s.trials);
  fmt::print(out, "{}: {} sessions, {} trials, {} tones, {} events, {} annotations\n", verb,
             gone.sessions.size(), gone.trials, gone.tones, gone.events, gone.annotations);
  for (const auto& path : gone.removed_copies) fmt::print(out, "{}: {}\n", verb, path);
}

void print_what_stays(std::ostream& out, const store::Withdrawal& gone, const Options& options) {
  for (const auto& path : gone.remaining_copies)
    fmt::print(out, "{} still contains these data or cannot be read; remove it by hand\n", path);
  if (options.withdraw.backup_directory.empty())
    fmt::print(
        out,
        "Earlier backups were not searched; use --backups FOLDER to do so. Remove exported files by hand.\n");
}

/// Lists what would be deleted and asks for confirmation: the operator types the participant's code.
bool agreed(const Options& options, Context& context) {
  const auto plan = store::plan_withdrawal(options.database, options.withdraw);
  print(context.err, plan, "would be deleted");
  print_what_stays(context.err, plan, options);
  context.err << "This cannot be undone. Type the participant's code (" << options.withdraw.participant
              << ") to delete: " << std::flush;
  std::string answer;
  if (!std::getline(std::cin, answer))
    throw UsageError(
        "withdraw: standard input ended before anybody confirmed; nothing was deleted; use --yes in a "
        "script");
  return answer == options.withdraw.participant;
}

void withdraw(const Options& options, Context& context) {
  if (!options.dry_run && !options.yes && !agreed(options, context)) {
    context.err << "Nothing was deleted.\n";
    context.exit_code = 1;
    return;
  }
  const auto gone = options.dry_run ? store::plan_withdrawal(options.database, options.withdraw)
                                    : store::withdraw(options.database, options.withdraw);
  if (context.json) {
    print_json(context.out, to_json(gone, options));
  } else {
    print(context.out, gone, options.dry_run ? "would be deleted" : "deleted");
    print_what_stays(context.out, gone, options);
  }
  // As long as a copy remains, the withdrawal is incomplete, so report a failure.
  if (!options.dry_run && !gone.remaining_copies.empty()) context.exit_code = 1;
}

}  // namespace withdraw_command

void add_withdraw(CommandLine& app, Context& context) {
  using namespace withdraw_command;
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("withdraw", "Delete the data of a participant who withdraws; cannot be undone");
  add_database(*command, options->database);
  command
      ->add_option("--participant", options->withdraw.participant,
                   "Participant: CODE, or CODE@STATION if several people have this code")
      ->required();
  command->add_option("--station", options->withdraw.station, "Withdraw only the sessions at this station");
  command->add_option("--session", options->withdraw.session_id,
                      "Withdraw only this session; the participant's code stays in use");
  command
      ->add_option("--backups", options->withdraw.backup_directory,
                   "Folder with backups: make a new backup there and remove this database's backups that "
                   "contain the data")
      ->value("FOLDER");
  command->add_flag("--dry-run", options->dry_run, "List what would be deleted, and delete nothing");
  command->add_flag("--yes", options->yes, "Do not ask for confirmation (for scripts)");
  add_json(*command, context);
  command->footer("Example: turnpoint withdraw --db lab.sqlite --participant P01 --dry-run");
  command->callback([options, &context] { withdraw(*options, context); });
}

}  // namespace turnpoint::cli
