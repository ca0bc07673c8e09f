#include "station/collector/push.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <charconv>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/collector/received.hpp"
#include "station/collector/schema.hpp"
#include "station/protocol/visits.hpp"
#include "station/store/open.hpp"
#include "station/view/report_data.hpp"

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
  Json places = Json::array();
  for (const auto& [protocol_id, free] : report.places)
    places.push_back({{"protocol_id", protocol_id}, {"free", free}});
  return {{"sessions", sessions},
          {"running", report.running},
          {"other_stations", report.foreign},
          {"refused_stations", report.unsent},
          {"refused_withdrawals", report.disputed},
          {"withdrawn_here", withdrawn},
          {"places", places},
          {"waiting", report.waiting},
          {"remaining_copies", report.withdrawn.remaining_copies}};
}

void print(std::ostream& out, const collector::PushReport& report) {
  for (const auto& s : report.sessions)
    fmt::print(out, "{} {:<9} {} at {}, {} trials sent{}{}\n", s.session_id, collector::name(s.what),
               s.participant, s.station_id, s.trials, s.problem.empty() ? "" : ": ", s.problem);
  if (report.sessions.empty()) fmt::print(out, "no session to send\n");
  if (report.running > 0) fmt::print(out, "{} running, sent later\n", report.running);
  for (const auto& [protocol_id, free] : report.places)
    fmt::print(out, "{}: {} free places leased to this station\n", protocol_id, free);
  for (const auto& station : report.foreign)
    fmt::print(out, "sessions of station {} were merged from another database: that station sends them\n",
               station);
  for (const auto& station : report.unsent)
    fmt::print(
        out,
        "sessions of station {} were recorded here but are not sent: the server does not accept them from "
        "this role; give the station its earlier name, or assign this name to the role on the server\n",
        station);
  for (const auto& id : report.disputed)
    fmt::print(out, "withdrawal of session {} refused: it contradicts what the server knows of the session\n",
               id);
  for (const auto& s : report.withdrawn.sessions)
    fmt::print(out, "withdrawn on the server, deleted here: session {}, {} trials\n", s.session_id, s.trials);
  for (const auto& path : report.withdrawn.remaining_copies)
    fmt::print(out, "{} still contains withdrawn data or cannot be read; remove it by hand\n", path);
  if (!report.waiting.empty())
    fmt::print(out, "withdrawals or places from the server wait for the next push: {}\n", report.waiting);
}

struct Options {
  collector::PushOptions push;
  std::vector<std::string> places;
};

/// Reads the argument of --places: PROTOCOL=N.
std::pair<std::string, std::int64_t> place_option(const std::string& word) {
  const auto at = word.rfind('=');
  std::int64_t count = 0;
  const auto* end = word.data() + word.size();
  if (at == std::string::npos || at == 0 || std::from_chars(word.data() + at + 1, end, count).ptr != end ||
      count < 1 || count > 10000)
    throw UsageError(fmt::format("--places {}: write PROTOCOL=N, with N from 1 to 10000", word));
  return {word.substr(0, at), count};
}

void push(Options given, Context& context) {
  auto& options = given.push;
  for (const auto& word : given.places) options.places.insert(place_option(word));
  options.assignment = [&](const std::string& protocol_id, const std::set<std::string>& stations) {
    const auto protocol = view::newest_protocol(options.database, protocol_id, core::RunMode::live, stations);
    return protocol ? protocol::assignment(*protocol) : std::nullopt;
  };
  if (!options.return_places.empty() && (!options.received.empty() || !options.places.empty()))
    throw UsageError("--return-places cannot be combined with --places or --received");
  const auto report = collector::push(options);
  if (context.json)
    print_json(context.out, to_json(report));
  else
    print(context.out, report);
  if (!report.complete() || !report.withdrawn.remaining_copies.empty()) context.exit_code = 1;
}

}  // namespace push_command

void add_push(CommandLine& app, Context& context) {
  using namespace push_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("push", "Send the sessions that have ended to a collector (PostgreSQL)");
  add_database(*command, options->push.database);
  command
      ->add_option(
          "--to", options->push.to,
          "The collector, as a connection string of PostgreSQL: \"service=lab\", \"host=... dbname=...\" "
          "or postgresql://...")
      ->value("SERVER")
      ->required();
  command
      ->add_option("--backups", options->push.backup_directory,
                   "Folder with backups from which to remove what was withdrawn on the server")
      ->value("FOLDER");
  command
      ->add_option(
          "--received", options->push.received,
          "Do not change the database: write what the server sent to this file, for turnpoint receive")
      ->value("FILE");
  command
      ->add_option("--places", options->places,
                   "Lease places in the counterbalancing of a protocol, so that this station has N free ones")
      ->value("PROTOCOL=N");
  command
      ->add_option("--return-places", options->push.return_places,
                   "Give back the leased places of a protocol that no participant has")
      ->value("PROTOCOL");
  add_json(*command, context);
  command->footer("Example: turnpoint push --db lab.sqlite --to service=lab");
  command->callback([options, &context] { push(*options, context); });
}

void add_receive(CommandLine& app, Context& context) {
  struct Options {
    std::string database, file, backup_directory;
  };
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("receive", "Apply to the database what `push --received` got from the collector");
  add_database(*command, options->database);
  command->add_option("file", options->file, "File that push wrote")->value("FILE")->required();
  command
      ->add_option("--backups", options->backup_directory,
                   "Folder with backups from which to remove what was withdrawn on the server")
      ->value("FOLDER");
  command->footer("Example: turnpoint receive --db lab.sqlite received.json");
  command->callback([options, &context] {
    store::open_reader(options->database);  // A wrong database is reported before a wrong file.
    const auto gone = collector::carry_out(collector::read_received(options->file), options->database,
                                           options->backup_directory);
    fmt::print(context.out, "{} sessions withdrawn\n", gone.sessions.size());
    for (const auto& path : gone.remaining_copies)
      fmt::print(context.out, "{} still contains withdrawn data or cannot be read; remove it by hand\n",
                 path);
    if (!gone.remaining_copies.empty()) context.exit_code = 1;
  });
}

void add_collector_schema(CommandLine& app, Context& context) {
  auto* command = app.add_subcommand(
      "collector-schema", "Print the SQL that makes a PostgreSQL database a collector, or updates one");
  command->footer("Example: turnpoint collector-schema");
  command->callback([&context] { context.out << collector::schema_sql(); });
}

}  // namespace turnpoint::cli
