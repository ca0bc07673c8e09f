#pragma once
#include <string>
#include <vector>

#include "station/cli/command_line.hpp"

namespace turnpoint::cli {

// Options that several commands have. The same mistake gets the same message in each of them.

/// Adds the protocol: a file, or the name of a protocol that comes with the program. It is not required yet.
Option* add_protocol(Command& command, std::string& target);

/// Adds --rig: a file, or the name of a rig that comes with the program. `when` is added to the help; it
/// says which rig is used without the option.
Option* add_rig(Command& command, std::string& target,
                const std::string& when =
                    "by default the installed rig, or the simulated rig if none is "
                    "installed");

/// Adds --calibration: a file to use instead of the newest valid one beside the rig file.
Option* add_calibration(Command& command, std::string& target);

/// Adds --db, which is required. The file must exist, and begin as a database does.
void add_database(Command& command, std::string& target, const std::string& help = "Database");

/// Like add_database(), but also accepts the address of a collector (postgresql://...). For commands that only read.
void add_readable_database(Command& command, std::string& target);

/// Like add_readable_database(), for a command that can read several databases at once.
void add_databases(Command& command, std::vector<std::string>& target, const std::string& help);

/// Like add_database(), for a command that creates a missing database.
void add_new_database(Command& command, std::string& target, const std::string& help);

/// Accepts a file that can be a database. Leaves files that it cannot read to the store, which explains why.
Check database();

}  // namespace turnpoint::cli
