#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// The lines that a script in peers/ prints. .py files are run by python3, .js files by node with the
/// packages in NODE_PATH. Empty if the interpreter or a package is missing. Arguments are words without
/// quotes.
std::vector<std::string> run_peer(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace turnpoint::benchmark
