#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// The condition of a trial as `[analysis] by` groups trials: "dry", "mark 150 mm", "speed, mark 150 mm".
/// Without `by` it is the block's instruction; "" where there is none either.
std::string condition_of(const protocol::Protocol& protocol, const protocol::Factors& factors,
                         const std::string& instruction);

/// All conditions in the order of the levels in the protocol file, which is the same for each participant;
/// instructions in the order in which the file's blocks have them.
std::vector<std::string> conditions(const protocol::Protocol& protocol);

/// Without its unit, in words, and the unit: `mark_mm` is "mark" and "mm", `_um` has the unit \u00b5m; "" for
/// a factor whose name has no unit.
struct FactorWords {
  std::string name, unit;
};
FactorWords words_of(const std::string& factor);

}  // namespace turnpoint::protocol
