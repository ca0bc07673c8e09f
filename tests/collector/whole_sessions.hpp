#pragma once
#include <string>
#include <vector>

#include "tests/collector/postgres_server.hpp"

/// Checks that the server has each session of the databases completely, or not at all. Returns how many it
/// has.
int whole_sessions(const PostgresServer& postgres, const std::vector<std::string>& databases);
int whole_sessions(const PostgresServer& postgres, const std::string& database);
