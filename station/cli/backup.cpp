#include "station/store/backup.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/view/choices.hpp"

namespace turnpoint::cli {

namespace backup_command {

struct Options {
  std::string database;
  store::BackupOptions backup;
  std::string database_id, to = "folder";
  bool restore = false, drill = false, moved = false;
};

void back_up(const Options& options, Context& context) {
  auto how = options.backup;
  how.destination = options.to == "disk" ? store::Destination::disk : store::Destination::folder;
  const auto report = store::backup(options.database, how);
  if (context.json) {
    print_json(context.out, Json{{"path", report.path},
                                 {"number", report.number},
                                 {"sha256", report.sha256},
                                 {"bytes", report.bytes},
                                 {"sessions", report.sessions},
                                 {"trials", report.trials},
                                 {"removed", report.removed},
                                 {"unrecorded", report.unrecorded}});
    return;
  }
  fmt::print(context.out, "{}: {} sessions, {} trials, {} bytes; the backup was read back and checked\n",
             report.path, report.sessions, report.trials, report.bytes);
  for (const auto& path : report.removed) fmt::print(context.out, "rotated out: {}\n", path);
  if (!report.unrecorded.empty())
    fmt::print(context.out, "the note about this backup could not be written beside the database: {}\n",
               report.unrecorded);
}

void drill(const Options& options, Context& context) {
  const auto drill = store::drill_restore(options.database, options.backup.directory);
  if (!drill.problems.empty()) context.exit_code = 1;
  if (context.json) {
    print_json(context.out, Json{{"from", drill.from},
                                 {"number", drill.number},
                                 {"age_s", drill.age_s},
                                 {"sessions", drill.sessions},
                                 {"trials", drill.trials},
                                 {"live_sessions", drill.live_sessions},
                                 {"live_trials", drill.live_trials},
                                 {"problems", drill.problems}});
    return;
  }
  fmt::print(context.out,
             "the backup {} ({}) was restored into a temporary file, which was checked and removed again\n",
             drill.from, view::age_in_words(drill.age_s));
  fmt::print(
      context.out,
      "the backup contains {} sessions and {} trials; the database contains {} sessions and {} trials\n",
      drill.sessions, drill.trials, drill.live_sessions, drill.live_trials);
  for (const auto& problem : drill.problems) fmt::print(context.out, "{}\n", problem);
  if (drill.problems.empty()) fmt::print(context.out, "every row of the backup is as it was recorded\n");
}

void restore(const Options& options, Context& context) {
  const auto restored =
      store::restore_backup(options.database, {options.backup.directory, options.database_id,
                                               options.moved ? store::Whose::moved : store::Whose::found});
  if (!restored.changed.empty() || !restored.problems.empty()) context.exit_code = 1;
  if (context.json) {
    print_json(context.out, Json{{"from", restored.from},
                                 {"database_id", restored.database_id},
                                 {"quarantined", restored.quarantined},
                                 {"sessions", restored.sessions},
                                 {"trials", restored.trials},
                                 {"rejected", restored.rejected},
                                 {"changed", restored.changed},
                                 {"problems", restored.problems}});
    return;
  }
  for (const auto& path : restored.rejected)
    fmt::print(context.out, "this backup failed its check and was not used: {}\n", path);
  fmt::print(context.out, "{} was restored from {}, opened and checked: {} sessions, {} trials\n",
             options.database, restored.from, restored.sessions, restored.trials);
  for (const auto& id : restored.changed)
    fmt::print(context.out,
               "session {} differs from what was recorded, and already did when the backup was made; "
               "`turnpoint verify` lists the differences\n",
               id);
  for (const auto& problem : restored.problems)
    fmt::print(context.out, "already in the backup: {}\n", problem);
  if (!restored.quarantined.empty())
    fmt::print(context.out, "the previous file was kept as {}, together with its log if it had one\n",
               restored.quarantined);
}

}  // namespace backup_command

void add_backup(CommandLine& app, Context& context) {
  using namespace backup_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "backup",
      "Back up a database (even while it is in use), check the backup, and remove the oldest backups");
  command->add_option("--db", options->database, "Database")->value("FILE")->required();
  command->add_option("--dir", options->backup.directory, "Folder for the backups")
      ->value("FOLDER")
      ->required();
  command->add_option("--keep", options->backup.keep, "Number of backups to keep; 0 keeps all")
      ->check(not_negative())
      ->capture_default_str();
  command->add_flag("--restore", options->restore,
                    "Replace a damaged, empty or missing database by its newest intact backup");
  command->add_option(
      "--database-id", options->database_id,
      "With --restore: id of the database, if the folder contains backups of several databases");
  command->add_flag(
      "--moved", options->moved,
      "With --restore: this machine replaces the one that made the backups (another board or disk)");
  command
      ->add_option(
          "--to", options->to,
          "folder | disk; with disk, the backup is refused unless a disk other than that of the database is "
          "mounted at --dir or at the folder above it")
      ->check(one_of({"folder", "disk"}))
      ->capture_default_str();
  command->add_flag("--drill", options->drill,
                    "Restore the newest backup into a temporary file in --dir, check it, compare it with the "
                    "database, and remove it again");
  add_json(*command, context);
  command->footer(
      "Example: turnpoint backup --db lab.sqlite --dir backups --keep 30\n"
      "turnpoint-backup.timer makes a backup every day (deploy/README.md). The exit status is 1 if a backup, "
      "a restore\nor a drill found a problem.");
  command->callback([options, &context] {
    if (options->restore && options->drill) throw UsageError("--restore and --drill cannot be used together");
    if (options->backup.directory.empty())
      throw UsageError("--dir: the name of the folder must not be empty");
    if (const auto problem = database().problem(options->database); !options->restore && !problem.empty())
      throw UsageError("backup: --db: " + problem);
    if (options->drill)
      drill(*options, context);
    else if (options->restore)
      restore(*options, context);
    else
      back_up(*options, context);
  });
}

}  // namespace turnpoint::cli
