#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// The lines that a Python program prints; none where python3 is not there or the program fails (a package
/// that it imports is missing).
std::vector<std::string> run_python(const std::string& program);

/// Likewise for JavaScript, by node and the packages in NODE_PATH.
std::vector<std::string> run_node(const std::string& program);

}  // namespace turnpoint::benchmark
