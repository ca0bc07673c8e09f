#include "station/store/annotate.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"

namespace turnpoint::cli {

namespace annotate_command {

struct Options {
  std::string database, session, text;
};

void annotate(const Options& options, Context& context) {
  store::annotate(options.database, options.session, options.text);
  if (context.json)
    context.out << Json{{"session_id", options.session}, {"text", options.text}}.dump(2) << "\n";
  else
    fmt::print(context.out, "the note was added to session {}\n", options.session);
}

}  // namespace annotate_command

void add_annotate(CommandLine& app, Context& context) {
  using namespace annotate_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("annotate", "Add a note to a session without changing its trials");
  command->add_option("--db", options->database, "Database")->required();
  command->add_option("--session", options->session, "Session id; `turnpoint sessions` lists all ids")
      ->required();
  command->add_option("text", options->text, "The note")->required();
  add_json(*command, context);
  command->footer(
      "Example: turnpoint annotate --db lab.sqlite --session 2f1c... \"fire alarm during block 2\"");
  command->callback([options, &context] { annotate(*options, context); });
}

}  // namespace turnpoint::cli
