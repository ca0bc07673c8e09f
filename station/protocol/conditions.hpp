#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// The condition of a trial, from the factors that `[analysis] by` names: "dry", "mark 150 mm", "speed, mark
/// 150 mm". Without `by` it is the block's instruction; "" if there is none either.
std::string condition_of(const protocol::Protocol& protocol, const protocol::Factors& factors,
                         const std::string& instruction);

/// All conditions of the protocol, in the same order for every participant: that of the factor's levels in
/// the file. Instructions come in the order in which the file's blocks use them.
std::vector<std::string> conditions(const protocol::Protocol& protocol);

/// A factor's name in words and its unit: `mark_mm` gives "mark" and "mm", `_um` gives the unit \u00b5m. The
/// unit is "" if the name has none.
struct FactorWords {
  std::string name, unit;
};
FactorWords words_of(const std::string& factor);

}  // namespace turnpoint::protocol
