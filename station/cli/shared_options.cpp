#include "station/cli/shared_options.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "station/collector/fetch.hpp"
#include "station/session/places.hpp"

namespace turnpoint::cli {

namespace {

namespace fs = std::filesystem;

enum class Missing { allowed, refused };

std::string problem_of(const std::string& path, Missing missing) {
  if (path.empty()) return "the name of the file is empty";
  std::error_code error;
  const auto status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    return missing == Missing::allowed ? "" : fmt::format("there is no file {}; check the path", path);
  if (fs::is_directory(status)) return fmt::format("{} is a folder; name the database file in it", path);
  if (!fs::exists(status)) return "";
  if (!fs::is_regular_file(status)) return fmt::format("{} is not a file but a device or a pipe", path);
  const std::string begin("SQLite format 3\0", 16);
  std::string found(begin.size(), ' ');
  if (!std::ifstream(path, std::ios::binary).read(found.data(), static_cast<std::streamsize>(found.size())))
    return "";
  if (found == begin) return "";
  return fmt::format(
      "{} is not a database; name another file, or, if it was a database, restore its newest backup with "
      "turnpoint backup --restore",
      path);
}

Check database(Missing missing) {
  return {"", [missing](const std::string& path) { return problem_of(path, missing); }};
}

/// Accepts what database() accepts, and the address of a collector.
Check readable_database() {
  return {"", [](const std::string& path) {
            return collector::is_server(path) ? "" : problem_of(path, Missing::refused);
          }};
}

}  // namespace

Check database() { return database(Missing::refused); }

Option* add_protocol(Command& command, std::string& target) {
  return command.add_option("protocol", target, "Protocol file, or a name that `turnpoint protocols` lists")
      ->value("PROTOCOL")
      ->transform([](const std::string& named) { return session::file_or_shipped(named, "protocols"); });
}

Option* add_calibration(Command& command, std::string& target) {
  return command
      .add_option("--calibration", target,
                  "Calibration file; by default the newest valid one beside the rig file, if there is one")
      ->value("FILE");
}

Option* add_rig(Command& command, std::string& target, const std::string& when) {
  return command
      .add_option("--rig", target, "Rig file, or the name of a rig that comes with the program; " + when)
      ->value("RIG")
      ->transform([](const std::string& named) { return session::file_or_shipped(named, "deploy/rigs"); });
}

void add_database(Command& command, std::string& target, const std::string& help) {
  command.add_option("--db", target, help)->value("FILE")->required()->check(database());
}

void add_databases(Command& command, std::vector<std::string>& target, const std::string& help) {
  command.add_option("--db", target, help)->value("FILE")->required()->check(readable_database());
}

void add_readable_database(Command& command, std::string& target) {
  command.add_option("--db", target, "Database, or a collector: postgresql://USER@HOST/DATABASE")
      ->value("FILE")
      ->required()
      ->check(readable_database());
}

void add_new_database(Command& command, std::string& target, const std::string& help) {
  command.add_option("--db", target, help)->value("FILE")->required()->check(database(Missing::allowed));
}

}  // namespace turnpoint::cli
