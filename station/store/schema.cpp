#include "station/store/schema.hpp"

#include <fmt/format.h>

namespace turnpoint::store {

namespace {

[[noreturn]] void refuse(ErrorKind kind, const Database& database, const std::string& what) {
  throw StoreError(kind, fmt::format("database {}: {}", database.path(), what));
}

void apply(Database& database, int from, int to) {
  for (int version = from; version < to; ++version)
    database.execute(schema_steps()[static_cast<std::size_t>(version)]);
  database.execute(fmt::format("PRAGMA user_version = {}", to));
}

}  // namespace

int schema_version() { return static_cast<int>(schema_steps().size()); }

void create_schema(Database& database, int version) {
  Transaction transaction(database);
  database.execute(fmt::format("PRAGMA application_id = {}", kApplicationId));
  apply(database, 0, version);
  transaction.commit();
}

int checked_version(Database& database) {
  const auto application = database.integer("PRAGMA application_id");
  const auto version = database.integer("PRAGMA user_version");
  if (application != kApplicationId || version < 1)
    refuse(ErrorKind::not_a_database, database,
           "is an SQLite file, but not a Turnpoint database; nothing was changed; name another file, or one "
           "that does "
           "not "
           "exist yet");
  if (version > schema_version())
    refuse(ErrorKind::newer_schema, database,
           fmt::format("has schema version {}, but this program knows versions only up to {}; nothing was "
                       "changed; update Turnpoint "
                       "on this station",
                       version, schema_version()));
  return static_cast<int>(version);
}

void migrate(Database& database) {
  const int version = checked_version(database);
  if (version == schema_version()) return;
  Transaction transaction(database);
  apply(database, version, schema_version());
  transaction.commit();
}

}  // namespace turnpoint::store
