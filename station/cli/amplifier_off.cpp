#include "station/cli/run.hpp"
#include "station/io/amplifier.hpp"
#include "station/rig/rig.hpp"
#include "station/session/places.hpp"

namespace turnpoint::cli {

void add_amplifier_off(CommandLine& app, Context& context) {
  auto* command =
      app.add_subcommand("amplifier-off",
                         "Set the amplifier's enable line low after the station program has crashed. Accepts "
                         "the options with which the station was started, but uses only --rig");
  auto request = add_station_options(*command);
  command->footer("Example: turnpoint amplifier-off");
  command->callback([request, &context] {
    const auto path = session::rig_or_default(request->rig, context.err);
    const auto uri = rig::load(path).amplifier_uri;
    io::force_amplifier_off(uri);
    context.out << "amplifier off: " << uri << ", of " << path << "\n";
  });
}

}  // namespace turnpoint::cli
