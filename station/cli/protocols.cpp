#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/places.hpp"

namespace turnpoint::cli {

namespace protocols_command {

namespace fs = std::filesystem;

void protocols(const std::string& folder, Context& context) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) throw UsageError(fmt::format("{}: there is no such folder", folder));
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Json list = Json::array();
  for (const auto& file : files) {
    try {
      const auto protocol = protocol::load(file.string());
      list.push_back({{"path", file.string()},
                      {"id", protocol.id},
                      {"version", protocol.version},
                      {"title", protocol.title},
                      {"languages", protocol.languages}});
      if (!context.json) {
        std::string languages;
        for (const auto& language : protocol.languages)
          languages += (languages.empty() ? "" : ", ") + language;
        fmt::print(context.out, "{:<24} {} ({})\n  {}\n", protocol.id, protocol.title, languages,
                   file.string());
      }
    } catch (const core::BadInput& bad) {
      fmt::print(context.err, "{}\n", bad.what());
      context.exit_code = 2;
    }
  }
  if (context.json) print_json(context.out, list);
}

}  // namespace protocols_command

void add_protocols(CommandLine& app, Context& context) {
  using namespace protocols_command;
  auto folder = std::make_shared<std::string>();
  auto* command = app.add_subcommand("protocols", "Lists the protocols that come with the program");
  command->add_option("--folder", *folder, "List the protocol files of this folder instead")->value("FOLDER");
  add_json(*command, context);
  command->footer("Example: turnpoint protocols");
  command->callback(
      [folder, &context] { protocols(folder->empty() ? session::shipped("protocols") : *folder, context); });
}

}  // namespace turnpoint::cli
