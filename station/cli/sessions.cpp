#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/collector/fetch.hpp"
#include "station/core/number.hpp"
#include "station/protocol/visits.hpp"
#include "station/store/open.hpp"
#include "station/store/places.hpp"
#include "station/store/read.hpp"
#include "station/system/clocks.hpp"
#include "station/view/report_data.hpp"

namespace turnpoint::cli {

namespace sessions_command {

struct Options {
  std::string database;
  store::SessionFilter filter;
  bool places = false;
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

/// How many participants there are in a row of a design: in all, and by how far they have come.
struct Row {
  int started = 0, completed = 0, expected = 0, dropped_out = 0;
};

/// The rows of the design of a protocol: all, or those with a participant if there are many.
struct Design {
  std::string protocol_id;
  core::RunMode mode = core::RunMode::live;
  core::Assignment assignment;
  std::map<std::int64_t, Row> rows;
};

Design design_of(const std::string& path, const std::string& protocol_id, core::RunMode mode) {
  const auto protocol = view::newest_protocol(path, protocol_id, mode);
  Design design{protocol_id, mode, {}, {}};
  if (!protocol) return design;
  design.assignment = protocol::design(*protocol);
  if (design.assignment.rows <= 100)
    for (int row = 0; row < design.assignment.rows; ++row) design.rows[row];
  auto reader = store::open_reader(path);
  for (const auto& one :
       store::participations(reader, protocol_id, mode, design.assignment, system::realtime_ns())) {
    auto& row = design.rows[one.place % design.assignment.rows];
    ++row.started;
    ++(one.progress == store::Progress::completed  ? row.completed
       : one.progress == store::Progress::expected ? row.expected
                                                   : row.dropped_out);
  }
  return design;
}

void print(std::ostream& out, const Design& design) {
  fmt::print(out, "{}, {}: {} different places, {}\n", design.protocol_id, core::name(design.mode),
             design.assignment.rows,
             std::isinf(design.assignment.dropout_after_h)
                 ? "nobody is replaced"
                 : fmt::format("a participant is expected for {} h after the last session",
                               core::number(design.assignment.dropout_after_h)));
  fmt::print(out, "{:>7} {:>8} {:>10} {:>9} {:>12}\n", "place", "started", "completed", "expected",
             "dropped out");
  for (const auto& [place, row] : design.rows)
    fmt::print(out, "{:>7} {:>8} {:>10} {:>9} {:>12}\n", place, row.started, row.completed, row.expected,
               row.dropped_out);
}

Json to_json(const Design& design) {
  Json rows = Json::array();
  for (const auto& [place, row] : design.rows)
    rows.push_back({{"place", place},
                    {"started", row.started},
                    {"completed", row.completed},
                    {"expected", row.expected},
                    {"dropped_out", row.dropped_out}});
  return {{"protocol_id", design.protocol_id},
          {"run_mode", core::name(design.mode)},
          {"different_places", design.assignment.rows},
          {"dropout_after_h", json_number(design.assignment.dropout_after_h)},
          {"places", rows}};
}

/// Prints how many participants each place of each protocol has, without any session.
void places(const Options& options, const std::string& path, Context& context) {
  std::set<std::pair<std::string, core::RunMode>> studies;
  for (const auto& session : store::list_sessions(path, {"", "", options.filter.protocol_id}))
    studies.emplace(session.start.protocol_id, session.start.run_mode);
  Json json = Json::array();
  for (const auto& [protocol_id, mode] : studies) {
    const auto design = design_of(path, protocol_id, mode);
    if (context.json)
      json.push_back(to_json(design));
    else
      print(context.out, design);
  }
  if (context.json) return print_json(context.out, json);
  if (studies.empty()) fmt::print(context.out, "none\n");
}

void sessions(const Options& options, Context& context) {
  if (options.places && !(options.filter.session_id.empty() && options.filter.participant.empty()))
    throw UsageError("--places counts all participants: leave out --session and --participant");
  const collector::ReadableDatabase database(options.database, options.filter);
  if (options.places) return places(options, database.path(), context);
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
  command->add_flag(
      "--places", options->places,
      "Instead, count the participants at each place in the counterbalancing: started, completed, "
      "still expected, dropped out");
  add_json(*command, context);
  command->footer("Example: turnpoint sessions --db lab.sqlite");
  command->callback([options, &context] { sessions(*options, context); });
}

}  // namespace turnpoint::cli
