#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/store/people.hpp"

namespace turnpoint::cli {

namespace join_command {

struct Options {
  std::string database, first, second;
  bool undo = false;
};

void join(const Options& options, Context& context) {
  const auto relation = options.undo ? store::Relation::two_people : store::Relation::same_person;
  const auto label = store::join(options.database, options.first, options.second, relation);
  if (context.json)
    print_json(context.out, Json{{"participant", label}, {"joined", !options.undo}});
  else if (options.undo)
    fmt::print(context.out, "{} and {} are recorded as two people again\n", options.first, options.second);
  else
    fmt::print(context.out, "{} and {} are recorded as one person with the name {}\n", options.first,
               options.second, label);
}

}  // namespace join_command

void add_join(CommandLine& app, Context& context) {
  using namespace join_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("join", "Record that two participant codes belong to one person");
  add_database(*command, options->database);
  command
      ->add_option("first", options->first,
                   "First code: CODE@STATION, or a code that only one person has; the person gets this name")
      ->required();
  command
      ->add_option("second", options->second, "Second code: CODE@STATION, or a code that only one person has")
      ->required();
  command->add_flag("--undo", options->undo, "Undo a join: the two codes belong to two people");
  add_json(*command, context);
  command->footer("Example: turnpoint join --db lab.sqlite P01 P02");
  command->callback([options, &context] { join(*options, context); });
}

}  // namespace turnpoint::cli
