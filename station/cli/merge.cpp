#include "station/store/merge.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"

namespace turnpoint::cli {

namespace merge_command {

struct Options {
  std::string database;
  std::vector<std::string> sources;
};

Json to_json(const std::string& source, const store::MergeReport& report) {
  Json sessions = Json::array();
  for (const auto& s : report.sessions)
    sessions.push_back({{"session_id", s.session_id},
                        {"participant", s.participant},
                        {"protocol_id", s.protocol_id},
                        {"station_id", s.station_id},
                        {"what", store::name(s.what)},
                        {"trials", s.trials},
                        {"sha256", s.sha256}});
  return {{"source", source}, {"sessions", sessions}, {"withdrawn_there", report.withdrawn_there}};
}

void print(std::ostream& out, const std::string& source, const store::MergeReport& report) {
  fmt::print(out, "{}:\n", source);
  for (const auto& s : report.sessions)
    fmt::print(out, "  {} {:<9} {} of {} at {}, {} trials\n", s.session_id, store::name(s.what),
               s.participant, s.protocol_id, s.station_id, s.trials);
  for (const auto& id : report.withdrawn_there)
    fmt::print(out,
               "  session {} was withdrawn in the other database but is still in this one: withdraw its "
               "participant here too\n",
               id);
}

void merge(const Options& options, Context& context) {
  Json all = Json::array();
  for (const auto& source : options.sources) {
    const auto report = store::merge(options.database, source);
    if (context.json)
      all.push_back(to_json(source, report));
    else
      print(context.out, source, report);
  }
  if (context.json) print_json(context.out, all);
}

}  // namespace merge_command

void add_merge(CommandLine& app, Context& context) {
  using namespace merge_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("merge", "Merge the sessions of other stations' databases into one");
  add_new_database(*command, options->database, "Database to merge into; created if missing");
  command
      ->add_option("source", options->sources, "Databases or backups of other stations; they are not changed")
      ->value("FILE")
      ->required()
      ->check(database());
  add_json(*command, context);
  command->footer("Example: turnpoint merge --db all.sqlite lab.sqlite");
  command->callback([options, &context] { merge(*options, context); });
}

}  // namespace turnpoint::cli
