#include "tests/collector/whole_sessions.hpp"

#include "station/collector/fetch.hpp"
#include "station/store/checksum.hpp"
#include "station/store/sqlite.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

int whole_sessions(store::Database& there, const std::string& path) {
  store::Database here(path, store::Database::Access::read_only);
  store::Statement ids(here, "SELECT session_id FROM session");
  int whole = 0;
  while (ids.step()) {
    store::Statement known(there, "SELECT 1 FROM session WHERE session_id = ?");
    if (!known.bind(ids.text(0)).step()) continue;
    ++whole;
    CHECK(store::session_checksum(there, "main", ids.text(0)) ==
          store::session_checksum(here, "main", ids.text(0)));
  }
  return whole;
}

}  // namespace

int whole_sessions(const PostgresServer& postgres, const std::vector<std::string>& databases) {
  const collector::ReadableDatabase fetched(postgres.address("reader"));
  store::Database there(fetched.path(), store::Database::Access::read_only);
  int whole = 0;
  for (const auto& path : databases) whole += whole_sessions(there, path);
  return whole;
}

int whole_sessions(const PostgresServer& postgres, const std::string& database) {
  return whole_sessions(postgres, std::vector{database});
}
