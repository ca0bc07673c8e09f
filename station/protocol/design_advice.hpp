#pragma once
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// Matters of taste that a researcher should know of, each at the line of its key: levels of a factor, and
/// combinations of levels of several factors, that `balance` cannot spread evenly, with the counts that
/// result; a level that stands twice; times of 0.
std::vector<text::Problem> notes(const Protocol& protocol);

}  // namespace turnpoint::protocol
