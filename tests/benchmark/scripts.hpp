#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// The lines that a script of peers/ prints: .py by python3, .js by node and the packages in NODE_PATH. None
/// where the interpreter or a package is missing. Arguments are words without quotes.
std::vector<std::string> run_peer(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace turnpoint::benchmark
