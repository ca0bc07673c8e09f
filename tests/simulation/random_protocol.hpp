#pragma once
#include <map>
#include <random>
#include <string>

namespace turnpoint::tests {

/// Makes a random protocol file, for tests that must hold for any protocol. The same seed gives the same
/// file. `features` counts what was used: tasks, procedures, factors, catch trials, practice, roving, ...
std::string random_protocol(unsigned seed, std::map<std::string, int>& features);

}  // namespace turnpoint::tests
