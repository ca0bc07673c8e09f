#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/collector/fetch.hpp"
#include "station/store/read.hpp"

namespace turnpoint::cli {

namespace sessions_command {

struct Options {
  std::string database;
  store::SessionFilter filter;
};

Json to_json(const store::SessionRecord& session) {
  const auto& start = session.start;
  return {{"session_id", session.session_id},
          {"participant", start.participant},
          {"person", session.person},
          {"protocol_id", start.protocol_id},
          {"protocol_version", start.protocol_version},
          {"session_index", session.session_index},
          {"sequence_index", session.sequence_index},
          {"planned_session", start.planned_session ? Json(*start.planned_session) : Json(nullptr)},
          {"group", start.group.empty() ? Json(nullptr) : Json(start.group)},
          {"run_mode", core::name(start.run_mode)},
          {"status", core::name(session.status)},
          {"status_reason", session.status_reason},
          {"started", start.started_local},
          {"trials", session.trials},
          {"segments", session.segments},
          {"seed", start.seed},
          {"rig", start.rig_name},
          {"station_id", start.station_id},
          {"software_version", start.software_version},
          {"annotations", session.annotations}};
}

void print(std::ostream& out, const std::vector<store::SessionRecord>& sessions) {
  fmt::print(out, "{:<36}  {:<12} {:<24} {:>3} {:<9} {:<11} {:>6}  {}\n", "session", "participant",
             "protocol", "no", "mode", "status", "trials", "started");
  for (const auto& s : sessions) {
    fmt::print(out, "{:<36}  {:<12} {:<24} {:>3} {:<9} {:<11} {:>6}  {}{}\n", s.session_id, s.person,
               s.start.protocol_id, s.session_index, core::name(s.start.run_mode), core::name(s.status),
               s.trials, s.start.started_local,
               s.segments > 1 ? fmt::format(", resumed {} times", s.segments - 1) : "");
    for (const auto& note : s.annotations) fmt::print(out, "{:>38}note: {}\n", "", note);
  }
  if (sessions.empty()) fmt::print(out, "none\n");
}

void sessions(const Options& options, Context& context) {
  const collector::ReadableDatabase database(options.database, options.filter);
  const auto list = store::list_sessions(database.path(), options.filter);
  if (!context.json) return print(context.out, list);
  Json json = Json::array();
  for (const auto& session : list) json.push_back(to_json(session));
  print_json(context.out, json);
}

}  // namespace sessions_command

void add_sessions(CommandLine& app, Context& context) {
  using namespace sessions_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("sessions", "List the sessions of a database");
  add_readable_database(*command, options->database);
  command->add_option("--session", options->filter.session_id, "List only this session");
  command->add_option("--participant", options->filter.participant,
                      "List only this participant: CODE or CODE@STATION");
  command->add_option("--protocol", options->filter.protocol_id, "List only this protocol");
  add_json(*command, context);
  command->footer("Example: turnpoint sessions --db lab.sqlite");
  command->callback([options, &context] { sessions(*options, context); });
}

}  // namespace turnpoint::cli
