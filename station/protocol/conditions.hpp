#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// The name of a trial's condition, made from the factors that `[analysis] by` lists: "dry", "mark 150 mm",
/// "speed, mark 150 mm". Without `by` it is the block's instruction, or "" if the block has none.
std::string condition_of(const protocol::Protocol& protocol, const protocol::Factors& factors,
                         const std::string& instruction);

/// All conditions of the protocol, in the order of the factors' levels in the file. Without `by`,
/// instructions come in the order in which the blocks in the file use them. The order is the same for every
/// participant.
std::vector<std::string> conditions(const protocol::Protocol& protocol);

/// The group of participants that has a condition, in words, by the name of the condition. Empty if the
/// protocol has no groups or `by` names none: then every participant has all conditions.
std::map<std::string, std::string> groups_of_conditions(const protocol::Protocol& protocol);

/// The stimuli of a trial of a comparison, in order of presentation: the values of the factors that its
/// procedure sets. Empty if one of them has no value.
std::vector<double> compared(const procedure::Spec& spec, const Factors& factors);

/// The factor that an interval with these scenes presents, of those that the procedure of a comparison sets.
/// Empty if the scenes depend on none of them, or on several.
std::string presented(const Protocol& protocol, const procedure::Spec& spec,
                      const std::vector<std::string>& scenes);

/// A factor's name in words and its unit: `mark_mm` gives "mark" and "mm", `_um` gives the unit \u00b5m. The
/// unit is "" if the name has none.
struct FactorWords {
  std::string name, unit;
};
FactorWords words_of(const std::string& factor);

/// Returns a level of a factor in words: a named level as it is, a number with name and unit ("mark 150 mm").
std::string level_in_words(const std::string& factor, const FactorValue& value);

}  // namespace turnpoint::protocol
