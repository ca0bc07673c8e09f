#include "station/store/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/store/open.hpp"
#include "station/store/schema.hpp"
#include "station/store/seal.hpp"
#include "station/store/text_table.hpp"
#include "station/store/whole_file.hpp"

namespace turnpoint::store {

namespace {

struct Exported {
  std::string session_id, checksum;
};

/// Reads session_id and checksum of each session from an exported sessions.csv.
std::vector<Exported> read_export(const std::string& path) {
  const auto refuse = [&](const std::string& why) -> std::size_t {
    throw StoreError(ErrorKind::missing,
                     fmt::format("verify: {}; name a sessions.csv that `turnpoint export` wrote", why));
  };
  std::string bytes;
  try {
    bytes = core::read_file(path);
  } catch (const std::system_error& error) {
    refuse(error.what());
  }
  const auto lines = read_table(bytes);
  if (lines.empty()) refuse(path + ": the file is empty");
  const auto column = [&](const char* name) {
    const auto& head = lines.front();
    const auto at = std::find(head.begin(), head.end(), name);
    return at == head.end() ? refuse(fmt::format("{}: the file has no column {}", path, name))
                            : static_cast<std::size_t>(at - head.begin());
  };
  const auto id = column("session_id"), checksum = column("checksum");
  std::vector<Exported> sessions;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].size() != lines.front().size())
      refuse(fmt::format("{}: line {} is incomplete", path, i + 1));
    sessions.push_back({lines[i][id], lines[i][checksum]});
  }
  return sessions;
}

/// Adds a problem unless the session's chain in the database has a link with the exported checksum.
void compare(Database& database, const Exported& exported, Verification& result) {
  if (holds_link(database, exported.session_id, exported.checksum)) return;
  const auto problem =
      fmt::format("the checksum in the export, {}, does not occur in this session", exported.checksum);
  for (auto& session : result.sessions)
    if (session.session_id == exported.session_id) {
      session.problems.push_back(problem);
      return;
    }
  result.problems.push_back(
      fmt::format("session {} is in the export but not in the database", exported.session_id));
}

}  // namespace

std::vector<std::string> file_problems(Database& database) {
  auto problems = schema_problems(database);
  for (auto& problem : seal_problems(database)) problems.push_back(std::move(problem));
  const auto unused = [&](const char* table, const char* key, const std::string& users) {
    Statement rows(database, fmt::format("SELECT {1} FROM {0} WHERE {1} NOT IN ({2})", table, key, users));
    while (rows.step()) problems.push_back(fmt::format("{} {} belongs to no session", table, rows.text(0)));
  };
  unused("participant", "code", "SELECT participant FROM session UNION SELECT participant FROM enrolment");
  unused("protocol", "protocol_key", "SELECT protocol_key FROM session");
  unused("rig", "rig_key", "SELECT rig_key FROM session");
  unused("calibration", "calibration_id",
         "SELECT calibration_id FROM session WHERE calibration_id IS NOT NULL");
  return problems;
}

bool Verification::good() const {
  return problems.empty() && std::all_of(sessions.begin(), sessions.end(),
                                         [](const auto& session) { return session.problems.empty(); });
}

Verification verify(const std::string& path, const VerifyOptions& options) {
  std::vector<Exported> exported;
  if (!options.against.empty()) exported = read_export(options.against);
  auto database = open_reader(path);
  // one snapshot, because a session may be writing
  database.execute("BEGIN");
  check_pages(database);
  Verification result;
  result.problems = file_problems(database);
  if (options.session_id.empty())
    result.sessions = verify_database(database);
  else
    result.sessions.push_back(verify_session(database, options.session_id));
  for (const auto& one : exported)
    if (options.session_id.empty() || options.session_id == one.session_id) compare(database, one, result);
  return result;
}

}  // namespace turnpoint::store
