#include "station/view/preview.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/cli/run.hpp"
#include "station/cli/screens.hpp"
#include "station/cli/shared_options.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/system/write_file.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::cli {

namespace preview_command {

constexpr const char* without_screen = "without a screen use --out DIR";

struct Options {
  std::string protocol, rig, scene, out;
  std::vector<std::string> set;
};

void write(const std::filesystem::path& path, const std::string& text, std::ostream& messages) {
  system::write_file(path.string(), text);
  fmt::print(messages, "{}\n", path.string());
}

/// Writes the pictures of every requested scene. If a scene cannot be presented, prints the reason, continues
/// with the next scene, and sets a failing exit status at the end.
void preview_to_files(const Options& options, Context& context) {
  view::Preview preview(protocol::load(options.protocol),
                        session::calibrated_rig(options.rig, "", context.err));
  std::vector<std::string> assumed;
  const auto factors = view::factors_for(preview.protocol(), options.set, assumed);
  const auto scenes = options.scene.empty() ? preview.scenes() : std::vector<std::string>{options.scene};
  system::make_folder(options.out);
  const std::filesystem::path folder = options.out;
  for (const auto& scene : scenes) {
    if (!preview.protocol().scenes.count(scene))
      throw UsageError(fmt::format("--scene {}: the protocol has no such scene", scene));
    const auto look = preview.look(scene, factors);
    if (!look.problem.empty()) {
      fmt::print(context.err, "{}: {}\n", scene, look.problem);
      context.exit_code = 1;
      continue;
    }
    fmt::print(context.out, "Scene {}\n", scene);
    for (const auto* list : {&look.facts, &look.cues})
      for (const auto& [label, value] : *list)
        fmt::print(context.out, "  {}: {}\n", core::say(label, "en"), core::say(value, "en"));
    write(folder / (scene + "-surface.svg"), view::surface_svg(look, preview.rig()), context.out);
    write(folder / (scene + "-profile.svg"), report::render(view::profile_figure({look})), context.out);
    write(folder / (scene + "-spectrum.svg"), report::render(view::spectrum_figure(look)), context.out);
  }
}

}  // namespace preview_command

void add_preview(CommandLine& app, Context& context) {
  using namespace preview_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("preview", "Show the scenes of a protocol without a session");
  add_protocol(*command, options->protocol)->required();
  command->add_option("--scene", options->scene, "Name of the scene; by default all scenes");
  command->add_option(
      "--set", options->set,
      "Value of a factor, as factor=value; by default its first level or the middle of its range");
  add_rig(*command, options->rig);
  command
      ->add_option("--out", options->out,
                   "Folder in which to write SVG pictures, instead of showing a screen with sliders")
      ->value("FOLDER");
  command->footer("Example: turnpoint preview demo --scene edge --set offset_mm=9 --out looks");
  command->callback([options, &context] {
    if (options->out.empty() && !context.screens) return become_ui(context, without_screen);
    options->rig = session::rig_or_default(options->rig, context.err);
    if (!options->out.empty()) return preview_to_files(*options, context);
    with_screen(without_screen, [&] {
      context.screens->preview({options->protocol, options->rig, options->scene, options->set});
    });
  });
}

}  // namespace turnpoint::cli
