#pragma once
#include <string>
#include <vector>

#include "station/cli/command_line.hpp"

namespace turnpoint::cli {

/// What a shell may offer for the last of these words, which follow the program's name and may be empty.
/// Besides words, the list may have ":files" and ":folders", for which the shell offers what exists.
std::vector<std::string> completions(const std::vector<CommandText>& commands,
                                     std::vector<std::string> words);

}  // namespace turnpoint::cli
