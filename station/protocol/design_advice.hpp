#pragma once
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// Notes that are not errors but that a researcher should know, each at the line of its key: levels or
/// combinations of factors that `balance` cannot spread evenly, with the resulting counts; a level that is
/// listed twice; times of 0.
std::vector<text::Problem> notes(const Protocol& protocol);

}  // namespace turnpoint::protocol
