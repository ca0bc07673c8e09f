#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/store/station.hpp"

namespace turnpoint::cli {

namespace station_name_command {

struct Options {
  std::string database;
  store::StationName how;
  bool moved = false;
};

void print(std::ostream& out, const store::NamedStation& station) {
  const auto here = store::machine_identity();
  fmt::print(out, "station {}, database {}\n",
             station.name.empty() ? store::suggested_station_name() + " (not chosen yet)" : station.name,
             station.database_id);
  if (!station.was.empty() && station.was != station.name)
    fmt::print(out, "it was {}; {} stored sessions have the new name\n", station.was, station.sessions);
  if (station.is_new_identity)
    fmt::print(out, "this copy is a station of its own now: its database has another id than the original\n");
  fmt::print(out, "machine: {}\n",
             station.machine.empty() || here.empty() ? "not known"
             : station.machine == here               ? "this one"
                                                     : "another one than this");
  if (store::machine_traits().hardware.empty())
    fmt::print(
        out,
        "this machine has no number of its own from its maker that users may read, so a copy of its disk in "
        "another one is not noticed\n");
}

void name_station(const Options& options, Context& context) {
  auto how = options.how;
  if (options.moved) how.whose = store::Whose::moved;
  if (how.stored_sessions && how.name.empty()) throw UsageError("station-name: --stored needs a new name");
  const bool only_show = how.name.empty() && !options.moved;
  const auto station =
      only_show ? store::read_station(options.database) : store::name_station(options.database, how);
  if (context.json)
    context.out << Json{{"station", station.name},
                        {"was", station.was},
                        {"machine", station.machine},
                        {"this_machine", store::machine_identity()},
                        {"database_id", station.database_id},
                        {"renamed_sessions", station.sessions},
                        {"new_identity", station.is_new_identity}}
                       .dump(2)
                << "\n";
  else
    print(context.out, station);
}

}  // namespace station_name_command

void add_station_name(CommandLine& app, Context& context) {
  using namespace station_name_command;
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("station-name", "Show or choose the name under which a database records sessions");
  add_new_database(*command, options->database, "Database; created if missing");
  command->add_option("name", options->how.name, "New name of the station; a copy of a database needs one");
  command->add_flag("--moved", options->moved,
                    "This machine replaces the one that the database knows (another board or disk)");
  command->add_flag(
      "--stored", options->how.stored_sessions,
      "Give the new name also to the sessions that are stored; for two machines that have recorded under "
      "one name");
  add_json(*command, context);
  command->footer("Example: turnpoint station-name --db lab.sqlite bench-2");
  command->callback([options, &context] { name_station(*options, context); });
}

}  // namespace turnpoint::cli
