#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/maintenance/doctor.hpp"
#include "station/setup/places.hpp"
#include "station/setup/prepare.hpp"

namespace turnpoint::cli {

namespace doctor_command {

const char* word(lines::Finding::Status status) {
  switch (status) {
    case lines::Finding::Status::ok:
      return "ok";
    case lines::Finding::Status::warning:
      return "warning";
    case lines::Finding::Status::failed:
      return "failed";
  }
  return "?";
}

void doctor(const std::string& rig_path, const std::string& data_path, Context& context) {
  const auto rig = setup::calibrated_rig(setup::rig_or_default(rig_path, context.err), "", context.err);
  const auto checks = maintenance::examine(rig, data_path);
  Json list = Json::array();
  for (const auto& check : checks) {
    const auto name = texts::say(check.name, "en"), what = texts::say(check.what, "en"),
               mend = texts::say(check.mend, "en");
    list.push_back({{"name", name}, {"status", word(check.status)}, {"what", what}, {"mend", mend}});
    if (context.json) continue;
    fmt::print(context.out, "{:<20} {:<8} {}\n", name, word(check.status), what);
    if (!mend.empty()) fmt::print(context.out, "{:<29} -> {}\n", "", mend);
  }
  const bool fit = maintenance::fit_for_use(checks);
  if (context.json) context.out << Json{{"rig", rig.name}, {"fit", fit}, {"checks", list}}.dump(2) << "\n";
  context.exit_code = fit ? 0 : 1;
}

}  // namespace doctor_command

void add_doctor(CommandLine& app, Context& context) {
  using namespace doctor_command;
  auto* command =
      app.add_subcommand("doctor", "Check the hardware of a rig; exit status 1 if something is wrong");
  auto rig = std::make_shared<std::string>();
  auto data = std::make_shared<std::string>();
  add_rig(*command, *rig);
  command->add_option("--data", *data, "Folder for databases; by default the one in the user's data folder")
      ->value("FOLDER");
  add_json(*command, context);
  command->footer("Example: turnpoint doctor");
  command->callback([rig, data, &context] {
    if (data->empty()) *data = std::filesystem::path(setup::default_database()).parent_path().string();
    doctor(*rig, *data, context);
  });
}

}  // namespace turnpoint::cli
