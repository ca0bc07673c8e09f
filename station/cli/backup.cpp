#include "station/store/backup.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"

namespace turnpoint::cli {

namespace {

struct Options {
  std::string database;
  store::BackupOptions backup;
  std::string database_id;
  bool restore = false;
};

void back_up(const Options& options, Context& context) {
  const auto report = store::backup(options.database, options.backup);
  if (context.json) {
    context.out << Json{{"path", report.path},      {"number", report.number},     {"sha256", report.sha256},
                        {"bytes", report.bytes},    {"sessions", report.sessions}, {"trials", report.trials},
                        {"removed", report.removed}}
                       .dump(2)
                << "\n";
    return;
  }
  fmt::print(context.out, "{}: {} sessions, {} trials, {} bytes, read back and checked\n", report.path,
             report.sessions, report.trials, report.bytes);
  for (const auto& path : report.removed) fmt::print(context.out, "rotated out: {}\n", path);
}

void restore(const Options& options, Context& context) {
  const auto restored =
      store::restore_backup(options.database, {options.backup.directory, options.database_id});
  if (!restored.changed.empty()) context.exit_code = 1;
  if (context.json) {
    context.out << Json{{"from", restored.from},
                        {"database_id", restored.database_id},
                        {"quarantined", restored.quarantined},
                        {"sessions", restored.sessions},
                        {"trials", restored.trials},
                        {"rejected", restored.rejected},
                        {"changed", restored.changed}}
                       .dump(2)
                << "\n";
    return;
  }
  for (const auto& path : restored.rejected) fmt::print(context.out, "failed its check: {}\n", path);
  fmt::print(context.out, "{} restored from {}: {} sessions, {} trials, opened and checked\n",
             options.database, restored.from, restored.sessions, restored.trials);
  for (const auto& id : restored.changed)
    fmt::print(context.out,
               "session {} is not as it was recorded, and was not when the backup was made; "
               "`turnpoint verify` says what differs\n",
               id);
  if (!restored.quarantined.empty())
    fmt::print(context.out, "what was there before is kept as {}, with its log if it had one\n",
               restored.quarantined);
}

}  // namespace

void add_backup(CommandLine& app, Context& context) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("backup", "Copy a database, also a running one, check the copy, keep the newest");
  command->add_option("--db", options->database, "Database")->required();
  command->add_option("--dir", options->backup.directory, "Folder of the backups")->required();
  command->add_option("--keep", options->backup.keep, "How many stay; 0 keeps all")
      ->check(not_negative())
      ->capture_default_str();
  command->add_flag("--restore", options->restore,
                    "Put the newest good backup in the place of a damaged, empty or missing database");
  command->add_option("--database-id", options->database_id,
                      "With --restore: whose backups, where the folder holds those of several databases");
  add_json(*command, context);
  command->footer("Example: turnpoint backup --db lab.sqlite --dir /mnt/backup --keep 30");
  command->callback([options, &context] {
    if (options->restore)
      restore(*options, context);
    else
      back_up(*options, context);
  });
}

}  // namespace turnpoint::cli
