#pragma once
#include <set>
#include <string>

namespace turnpoint::tests {

/// Every key that the reader of protocol files knows, asked from the reader itself: an unknown key is put
/// into each table of the shipped files, and the messages list what is known there.
std::set<std::string> known_keys();

}  // namespace turnpoint::tests
