#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/store/verify.hpp"

namespace turnpoint::cli {

namespace verify_command {

struct Options {
  std::string database;
  store::VerifyOptions verify;
};

Json to_json(const store::Verification& result) {
  Json sessions = Json::array();
  for (const auto& s : result.sessions)
    sessions.push_back({{"session_id", s.session_id},
                        {"participant", s.participant},
                        {"protocol_id", s.protocol_id},
                        {"trials", s.trials},
                        {"links", s.links},
                        {"checksum", s.last_sha256.empty() ? Json(nullptr) : Json(s.last_sha256)},
                        {"problems", s.problems}});
  return {{"good", result.good()}, {"problems", result.problems}, {"sessions", sessions}};
}

void print(std::ostream& out, const store::Verification& result) {
  int changed = 0;
  for (const auto& s : result.sessions) {
    changed += !s.problems.empty();
    fmt::print(out, "{}  {} {}, {} trials: {}\n", s.session_id, s.participant, s.protocol_id, s.trials,
               s.problems.empty() ? "as recorded, checksum " + s.last_sha256 : "CHANGED");
    for (const auto& problem : s.problems) fmt::print(out, "    {}\n", problem);
  }
  for (const auto& problem : result.problems) fmt::print(out, "{}\n", problem);
  fmt::print(out, "{} sessions, {} changed{}\n", result.sessions.size(), changed,
             result.problems.empty() ? "" : fmt::format(", {} other problems", result.problems.size()));
}

void verify(const Options& options, Context& context) {
  const auto result = store::verify(options.database, options.verify);
  if (!result.good()) context.exit_code = 1;
  if (context.json)
    print_json(context.out, to_json(result));
  else
    print(context.out, result);
}

}  // namespace verify_command

void add_verify(CommandLine& app, Context& context) {
  using namespace verify_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("verify", "Check that the stored data are as they were recorded");
  add_database(*command, options->database, "Database or backup to check; it is not changed");
  command->add_option("--session", options->verify.session_id, "Check only this session");
  command
      ->add_option("--against", options->verify.against,
                   "A sessions.csv exported earlier: its checksums must still be in the database")
      ->value("FILE");
  add_json(*command, context);
  command->footer(
      "Example: turnpoint verify --db lab.sqlite\n"
      "The exit status is 1 if anything was changed, added or removed.");
  command->callback([options, &context] { verify(*options, context); });
}

}  // namespace turnpoint::cli
