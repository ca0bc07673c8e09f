#pragma once
#include <map>
#include <random>
#include <string>

namespace turnpoint::tests {

/// Makes a random protocol file, for tests that must hold for any protocol. The same seed gives the same
/// file. `features` counts how often each task, procedure, factor, catch trial, practice block, roving and so
/// on was used.
std::string random_protocol(unsigned seed, std::map<std::string, int>& features);

}  // namespace turnpoint::tests
