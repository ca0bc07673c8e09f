#pragma once
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// One source of trials in a block: a procedure, fixed levels, or catch trials.
struct Source {
  const Block* block = nullptr;
  /// name of the source for messages: `procedure "levels"`, `fixed levels`, `catch trials`
  core::Phrase what;
  std::string level;  ///< name of the factor whose levels the source presents
  /// values that this factor can take; for a staircase or slider, or for series that start
  /// anywhere, evenly spaced samples
  std::vector<double> levels;
  /// name of the factor of the procedure's second dimension, and its values; "" if there is none
  std::string second = {};
  std::vector<double> seconds = {};
  /// names of all factors that the source or its block sets; the values of other factors are drawn at random
  std::set<std::string> sets;
  const procedure::Spec* spec = nullptr;
};

/// All sources of trials. The pointers point into the protocol.
std::vector<Source> sources_of(const Protocol& protocol);

/// All expressions of a scene. The pointers point into the scene.
std::vector<const Linear*> expressions_of(const Scene& scene);

/// The factors on which the tasks' scenes, their right answers and their times depend.
std::set<std::string> factors_used(const Protocol& protocol);

/// The scenes that the tasks present, each once.
std::vector<std::string> scenes_used(const Protocol& protocol);

/// Returns a value for each factor: its first level or, if it has no levels, the middle of its range.
Factors any_factors(const Protocol& protocol);

/// Values that stand for all that a factor can be where it is drawn at random, that is, where neither a
/// procedure nor a block sets it: its levels, or evenly spaced values of its range. Empty if it is never
/// drawn.
std::vector<FactorValue> drawn_values(const Factor& factor);

const procedure::Spec* find_procedure(const Protocol& protocol, const std::string& name);
/// True if this is the name of a procedure whose levels a separate program chooses.
bool is_program(const Protocol& protocol, const std::string& name);
const Block& block_of(const std::variant<Block, Sequence>& part);

/// The blocks of all participants: a sequence gives one block for each level of its factor.
std::vector<Block> all_blocks(const Protocol& protocol);

/// The deadline that the block's instruction sets; null if the deadline of [timing] holds.
const Linear* deadline_of_instruction(const Protocol& protocol, const Block& block);

}  // namespace turnpoint::protocol
