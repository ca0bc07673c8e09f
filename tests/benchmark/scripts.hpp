#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// Runs a script of peers/ and returns the lines that it prints. .py files are run by python3, .js files by
/// node with the packages in NODE_PATH. Empty if the interpreter or a package is missing. Arguments must not
/// need quotes.
std::vector<std::string> run_peer(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace turnpoint::benchmark
