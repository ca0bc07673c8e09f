#pragma once
#include <string>
#include <vector>

#include "station/cli/command_line.hpp"

namespace turnpoint::cli {

/// Writes the manual pages turnpoint.1, turnpoint-ui.1 and turnpoint-COMMAND.1 into a folder, which is
/// created if missing. They contain the same texts as --help. Throws std::system_error.
void write_manual(const std::vector<CommandText>& commands, const std::string& description,
                  const std::string& folder);

/// Returns what a shell may offer to complete the last of these words. The words follow the program's name;
/// the last one may be empty. Besides words, the result may contain ":files" and ":folders": the shell then
/// offers existing files or folders.
std::vector<std::string> completions(const std::vector<CommandText>& commands,
                                     std::vector<std::string> words);

}  // namespace turnpoint::cli
