#pragma once
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// Facts that are not errors but that a researcher should know, each at the line of its key: counts of levels
/// or combinations that `balance` cannot make equal, levels that are listed twice, pauses of 0 s.
std::vector<core::Problem> notes(const Protocol& protocol);

}  // namespace turnpoint::protocol
