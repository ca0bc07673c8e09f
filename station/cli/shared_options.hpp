#pragma once
#include <string>
#include <vector>

#include "station/cli/command_line.hpp"

namespace turnpoint::cli {

// Each function adds an option that several commands share, so that all of them give the same message for the
// same mistake.

/// Adds the protocol: a file, or the name of a protocol that comes with the program. The argument is optional
/// unless the caller makes it required.
Option* add_protocol(Command& command, std::string& target);

/// Adds --rig: a file, or the name of a rig that comes with the program. `when` is added to the help; it
/// says which rig is used without the option.
Option* add_rig(Command& command, std::string& target,
                const std::string& when =
                    "by default the installed rig, or the simulated rig if none is "
                    "installed");

/// Adds --calibration: a file to use instead of the newest valid one beside the rig file.
Option* add_calibration(Command& command, std::string& target);

/// Adds --db, which is required. The file must exist, and begin like an SQLite database.
void add_database(Command& command, std::string& target, const std::string& help = "Database");

/// Like add_database(), but also accepts the address of a collector (postgresql://...). For commands that
/// only read.
void add_readable_database(Command& command, std::string& target);

/// Like add_readable_database(), for a command that can read several databases at once.
void add_databases(Command& command, std::vector<std::string>& target, const std::string& help);

/// Like add_database(), for a command that creates a missing database.
void add_new_database(Command& command, std::string& target, const std::string& help);

/// Accepts a file that can be a database. Also accepts a file that cannot be read: opening it in the store
/// gives the reason.
Check database();

}  // namespace turnpoint::cli
