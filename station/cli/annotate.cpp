#include "station/store/session_log.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/view/report_data.hpp"

namespace turnpoint::cli {

namespace annotate_command {

struct Options {
  std::string database, session, text;
};

void annotate(const Options& options, Context& context) {
  const auto id = options.session.empty() ? view::session_to_report(options.database, {}) : options.session;
  store::annotate(options.database, id, options.text);
  if (context.json)
    print_json(context.out, Json{{"session_id", id}, {"text", options.text}});
  else
    fmt::print(context.out, "the note was added to session {}\n", id);
}

}  // namespace annotate_command

void add_annotate(CommandLine& app, Context& context) {
  using namespace annotate_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("annotate", "Add a note to a session without changing its trials");
  add_database(*command, options->database);
  command->add_option("--session", options->session,
                      "Session id, which `turnpoint sessions` lists; by default the newest session");
  command->add_option("text", options->text, "The note")->required();
  add_json(*command, context);
  command->footer("Example: turnpoint annotate --db lab.sqlite \"fire alarm during block 2\"");
  command->callback([options, &context] { annotate(*options, context); });
}

}  // namespace turnpoint::cli
