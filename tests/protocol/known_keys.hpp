#pragma once
#include <set>
#include <string>

namespace turnpoint::tests {

/// All keys that the reader of protocol files knows. They are found by adding an unknown key to each table of
/// the shipped files, because the reader's messages then list the known keys.
std::set<std::string> known_keys();

}  // namespace turnpoint::tests
