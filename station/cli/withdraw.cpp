#include "station/store/withdraw.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"

namespace turnpoint::cli {

namespace {

struct Options {
  std::string database, participant, backups;
};

Json to_json(const store::Withdrawal& gone) {
  Json sessions = Json::array();
  for (const auto& s : gone.sessions)
    sessions.push_back({{"session_id", s.session_id},
                        {"protocol_id", s.start.protocol_id},
                        {"started", s.start.started_local},
                        {"trials", s.trials}});
  return {{"participant", gone.participant},
          {"sessions", sessions},
          {"trials", gone.trials},
          {"tones", gone.tones},
          {"events", gone.events},
          {"annotations", gone.annotations},
          {"removed_copies", gone.removed_copies},
          {"remaining_copies", gone.remaining_copies}};
}

void print(std::ostream& out, const store::Withdrawal& gone, const Options& options) {
  for (const auto& s : gone.sessions)
    fmt::print(out, "removed: session {}, {} of {}, {} trials\n", s.session_id, s.start.protocol_id,
               s.start.started_local, s.trials);
  fmt::print(out, "{}: {} sessions, {} trials, {} tones, {} events, {} annotations removed\n",
             gone.participant, gone.sessions.size(), gone.trials, gone.tones, gone.events, gone.annotations);
  for (const auto& path : gone.removed_copies) fmt::print(out, "backup removed: {}\n", path);
  for (const auto& path : gone.remaining_copies)
    fmt::print(out, "STILL HOLDS the participant, remove it: {}\n", path);
  if (options.backups.empty())
    fmt::print(out,
               "Earlier backups and exports are not searched: give --backups FOLDER, and remove exports by "
               "hand.\n");
}

void withdraw(const Options& options, Context& context) {
  const auto gone = store::withdraw(options.database, options.participant, options.backups);
  if (context.json)
    context.out << to_json(gone).dump(2) << "\n";
  else
    print(context.out, gone, options);
}

}  // namespace

void add_withdraw(CommandLine& app, Context& context) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("withdraw", "Delete all data of a participant who withdraws; cannot be undone");
  command->add_option("--db", options->database, "Database")->required();
  command->add_option("--participant", options->participant, "Participant code")->required();
  command->add_option(
      "--backups", options->backups,
      "Folder of the backups: a new one is made, those that hold the participant are removed");
  add_json(*command, context);
  command->footer("Example: turnpoint withdraw --db lab.sqlite --participant P07 --backups /mnt/backup");
  command->callback([options, &context] { withdraw(*options, context); });
}

}  // namespace turnpoint::cli
