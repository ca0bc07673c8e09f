#include "station/desk/report_data.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cerrno>
#include <memory>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/cli/shared_options.hpp"
#include "station/report/html.hpp"
#include "station/system/write_file.hpp"
#include "station/text/number.hpp"

namespace turnpoint::cli {

namespace report_command {

struct Options {
  std::string database, out;
  store::SessionFilter filter;
};

void report_session(Options options, Context& context) {
  const auto id = desk::session_to_report(options.database, options.filter);
  const auto summary = report::summarise(desk::report_data(options.database, id));
  if (context.json) context.out << report::to_json(summary) << "\n";
  if (options.out.empty() && !context.json) options.out = "report-" + id + ".html";
  if (options.out.empty()) return;
  system::write_file(options.out, report::to_html(summary));
  if (context.json) return;
  const auto& data = summary.data;
  fmt::print(context.out, "{}: session {} of {}, {}, {} trials\n", options.out, data.session_id,
             data.participant, data.title, summary.outcomes.presented);
  for (const auto& estimate : data.estimates)
    fmt::print(context.out, "  {}: {} {}{}\n", estimate.procedure, estimate.parameter,
               text::number(estimate.mean, 4),
               estimate.sd ? fmt::format(" (SD {})", text::number(*estimate.sd, 3)) : "");
}

}  // namespace report_command

void add_report(CommandLine& app, Context& context) {
  using namespace report_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "report", "Write a report of a session: fits, bias, speed-accuracy trade-off, health");
  add_database(*command, options->database);
  command->add_option("--session", options->filter.session_id,
                      "Session to report; by default the newest one");
  command->add_option("--participant", options->filter.participant,
                      "Report the newest session of this participant: CODE or CODE@STATION");
  command->add_option("--protocol", options->filter.protocol_id,
                      "Report the newest session of this protocol");
  command
      ->add_option("--out", options->out,
                   "HTML file to write; by default report-SESSION.html, or no file with --json")
      ->value("FILE");
  add_json(*command, context);
  command->footer("Example: turnpoint report --db lab.sqlite --participant P01 --out P01.html");
  command->callback([options, &context] { report_session(*options, context); });
}

}  // namespace turnpoint::cli
