#include "station/collector/push.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/collector/schema.hpp"

namespace turnpoint::cli {

namespace push_command {

Json to_json(const collector::PushReport& report) {
  Json sessions = Json::array();
  for (const auto& s : report.sessions)
    sessions.push_back({{"session_id", s.session_id},
                        {"participant", s.participant},
                        {"station_id", s.station_id},
                        {"what", collector::name(s.what)},
                        {"trials", s.trials},
                        {"sha256", s.sha256},
                        {"problem", s.problem}});
  Json withdrawn = Json::array();
  for (const auto& s : report.withdrawn.sessions) withdrawn.push_back(s.session_id);
  return {{"sessions", sessions},
          {"running", report.running},
          {"other_stations", report.foreign},
          {"withdrawn_here", withdrawn},
          {"not_withdrawn", report.not_withdrawn},
          {"remaining_copies", report.withdrawn.remaining_copies}};
}

void print(std::ostream& out, const collector::PushReport& report) {
  for (const auto& s : report.sessions)
    fmt::print(out, "{} {:<9} {} at {}, {} trials sent{}{}\n", s.session_id, collector::name(s.what),
               s.participant, s.station_id, s.trials, s.problem.empty() ? "" : ": ", s.problem);
  if (report.sessions.empty()) fmt::print(out, "no session to send\n");
  if (report.running > 0) fmt::print(out, "{} running, sent later\n", report.running);
  for (const auto& station : report.foreign)
    fmt::print(out, "sessions of station {} are not sent: the server does not accept them from this role\n",
               station);
  for (const auto& s : report.withdrawn.sessions)
    fmt::print(out, "withdrawn on the server, deleted here: session {}, {} trials\n", s.session_id, s.trials);
  for (const auto& path : report.withdrawn.remaining_copies)
    fmt::print(out, "{} still contains withdrawn data or cannot be read; remove it by hand\n", path);
  if (!report.not_withdrawn.empty())
    fmt::print(out, "withdrawals from the server wait for the next push: {}\n", report.not_withdrawn);
}

void push(const collector::PushOptions& options, Context& context) {
  const auto report = collector::push(options);
  if (context.json)
    context.out << to_json(report).dump(2) << "\n";
  else
    print(context.out, report);
  if (!report.complete() || !report.withdrawn.remaining_copies.empty()) context.exit_code = 1;
}

}  // namespace push_command

void add_push(CommandLine& app, Context& context) {
  using namespace push_command;
  auto options = std::make_shared<collector::PushOptions>();
  auto* command = app.add_subcommand("push", "Send the sessions that have ended to a collector (PostgreSQL)");
  add_database(*command, options->database);
  command
      ->add_option(
          "--to", options->to,
          "The collector, as a connection string of PostgreSQL: \"service=lab\", \"host=... dbname=...\" "
          "or postgresql://...")
      ->value("SERVER")
      ->required();
  command
      ->add_option("--backups", options->backup_directory,
                   "Folder with backups from which to remove what was withdrawn on the server")
      ->value("FOLDER");
  add_json(*command, context);
  command->footer("Example: turnpoint push --db lab.sqlite --to service=lab");
  command->callback([options, &context] { push(*options, context); });
}

void add_collector_schema(CommandLine& app, Context& context) {
  auto* command = app.add_subcommand(
      "collector-schema", "Print the SQL that makes a PostgreSQL database a collector, or updates one");
  command->footer("Example: turnpoint collector-schema | psql --dbname turnpoint");
  command->callback([&context] { context.out << collector::schema_sql(); });
}

}  // namespace turnpoint::cli
