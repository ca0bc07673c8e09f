#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/session/self_test_rig.hpp"

namespace turnpoint::cli {

namespace self_test_command {

struct Options {
  std::string rig, calibration, data;
  bool unattended = false;
};

void ask(const session::Request& request, std::ostream& err) {
  using Kind = session::Request::Kind;
  if (request.kind == Kind::press_stop) err << "press the stop button" << std::endl;
  if (request.kind == Kind::release_stop) err << "release the stop button" << std::endl;
  if (request.kind == Kind::press_button) err << "press the button \"" << request.name << "\"" << std::endl;
}

Json to_json(const std::vector<core::CheckRow>& checks) {
  Json list = Json::array();
  for (const auto& check : checks)
    list.push_back({{"name", check.name},
                    {"verdict", core::name(check.verdict)},
                    {"value", json_number(check.value)},
                    {"limit", json_number(check.limit)},
                    {"unit", check.unit},
                    {"what", check.what}});
  return list;
}

void print(std::ostream& out, const std::vector<core::CheckRow>& checks) {
  for (const auto& check : checks)
    fmt::print(out, "{:<22} {:<13} {}\n", check.name, core::name(check.verdict), check.what);
}

void self_test(const Options& options, Context& context) {
  const auto rig = session::calibrated_rig(session::rig_or_default(options.rig, context.err),
                                           options.calibration, context.err);
  session::AskOperator asks;
  if (!options.unattended) asks = [&context](const session::Request& request) { ask(request, context.err); };
  const auto found = session::self_test(rig, asks, options.data);
  const bool good = session::passed(found);
  std::vector<core::CheckRow> checks;
  for (const auto& check : found) checks.push_back(session::row_of(check));
  context.exit_code = good ? 0 : 1;
  if (context.json) {
    print_json(context.out, Json{{"rig", rig.name}, {"passed", good}, {"checks", to_json(checks)}});
    return;
  }
  print(context.out, checks);
}

}  // namespace self_test_command

void add_self_test(CommandLine& app, Context& context) {
  using namespace self_test_command;
  auto* command = app.add_subcommand(
      "self-test",
      "Try the safe state, buttons, pick-ups and force cells of a rig; exit status 1 if a check failed");
  auto options = std::make_shared<Options>();
  add_rig(*command, options->rig);
  command
      ->add_option("--calibration", options->calibration,
                   "Calibration file; by default the newest one beside the rig file")
      ->value("FILE");
  command
      ->add_option("--data", options->data,
                   "Folder for databases; by default the one in the user's data folder")
      ->value("FOLDER");
  command->add_flag("--unattended", options->unattended,
                    "Leave out the checks for which somebody must press the stop and the buttons");
  add_json(*command, context);
  command->footer(
      "Example: turnpoint self-test --rig simulated\n"
      "The amplifier is armed and enabled, and a quiet tone is played on each transducer: keep everybody's "
      "fingers "
      "off the surface, and leave nothing on it.");
  command->callback([options, &context] {
    if (options->data.empty())
      options->data = std::filesystem::path(session::default_database()).parent_path().string();
    self_test(*options, context);
  });
}

}  // namespace turnpoint::cli
