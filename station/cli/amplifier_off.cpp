#include <memory>

#include "station/app/places.hpp"
#include "station/cli/command.hpp"
#include "station/panel/amplifier.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::cli {

void add_amplifier_off(CommandLine& app, Context& context) {
  auto* command = app.add_subcommand(
      "amplifier-off", "Drive the amplifier's enable line low: for what comes after a station that died");
  auto rig = std::make_shared<std::string>();
  command->add_option("--rig", *rig, "Rig file; otherwise the installed one, else the simulated one");
  command->footer("Example: turnpoint amplifier-off --rig /etc/turnpoint/rig.toml");
  command->callback([rig, &context] {
    const auto loaded = rig::load(app::rig_or_default(*rig, context.err));
    panel::force_amplifier_off(loaded.amplifier_uri);
    context.out << "amplifier off: " << loaded.amplifier_uri << "\n";
  });
}

}  // namespace turnpoint::cli
