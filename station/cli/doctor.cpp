#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/maintenance/doctor.hpp"
#include "station/maintenance/drive_crosstalk.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::cli {

namespace doctor_command {

const char* word(io::Finding::Status status) {
  switch (status) {
    case io::Finding::Status::ok:
      return "ok";
    case io::Finding::Status::warning:
      return "warning";
    case io::Finding::Status::failed:
      return "failed";
  }
  return "?";
}

struct DoctorOptions {
  std::string rig, data;
  bool weight = false, arm = false;
};

/// Has the operator put a weight on the plate, and switches the drive on and off under it.
std::vector<io::Finding> weigh_under_drive(const rig::Rig& rig, bool arm, Context& context) {
  if (!session::simulates_capture(rig) && !arm)
    throw UsageError(
        "doctor: --weight plays tones through the amplifier; make sure that nobody touches the surface, and "
        "add "
        "--arm");
  fmt::print(context.err, "Rest {:.0f} g on the middle of the plate, then press Enter ",
             maintenance::kRestingMass_g);
  context.err.flush();
  std::string line;
  if (!std::getline(std::cin, line))
    throw UsageError("doctor: --weight asks for a weight; the input ended before it stood");
  std::vector<io::Finding> findings;
  for (const auto& reading : maintenance::measure_drive_crosstalk(rig))
    findings.push_back(maintenance::judged(reading));
  return findings;
}

void doctor(const DoctorOptions& options, Context& context) {
  const auto rig =
      session::calibrated_rig(session::rig_or_default(options.rig, context.err), "", context.err);
  std::vector<io::Finding> checks;
  if (options.weight) checks = weigh_under_drive(rig, options.arm, context);
  for (auto& check : maintenance::examine(rig, options.data)) checks.push_back(std::move(check));
  Json list = Json::array();
  for (const auto& check : checks) {
    const auto name = core::say(check.name, "en"), what = core::say(check.what, "en"),
               mend = core::say(check.mend, "en");
    list.push_back({{"name", name}, {"status", word(check.status)}, {"what", what}, {"mend", mend}});
    if (context.json) continue;
    fmt::print(context.out, "{:<20} {:<8} {}\n", name, word(check.status), what);
    if (!mend.empty()) fmt::print(context.out, "{:<29} -> {}\n", "", mend);
  }
  const bool fit = maintenance::fit_for_use(checks);
  if (context.json) print_json(context.out, Json{{"rig", rig.name}, {"fit", fit}, {"checks", list}});
  context.exit_code = fit ? 0 : 1;
}

}  // namespace doctor_command

void add_doctor(CommandLine& app, Context& context) {
  using namespace doctor_command;
  auto* command =
      app.add_subcommand("doctor", "Check the hardware of a rig; exit status 1 if something is wrong");
  auto options = std::make_shared<DoctorOptions>();
  add_rig(*command, options->rig);
  command
      ->add_option("--data", options->data,
                   "Folder for databases; by default the one in the user's data folder")
      ->value("FOLDER");
  command->add_flag(
      "--weight", options->weight,
      "Also check that the drive does not change the force of 50 g at rest; asks for the weight");
  command->add_flag("--arm", options->arm,
                    "With --weight on a real rig: arm the amplifier; nobody may touch the surface");
  add_json(*command, context);
  command->footer("Example: turnpoint doctor");
  command->callback([options, &context] {
    if (options->data.empty())
      options->data = std::filesystem::path(session::default_database()).parent_path().string();
    doctor(*options, context);
  });
}

}  // namespace turnpoint::cli
