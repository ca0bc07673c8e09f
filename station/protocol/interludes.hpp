#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// The participant's answers and scores so far, by name: "about-you.age" or "practice.accuracy". If a
/// question was answered repeatedly, the newest value counts.
using Answers = std::map<std::string, FactorValue>;

/// True if the rule holds; false if the answer or score that it names does not exist yet.
bool holds(const AnswerCondition& rule, const Answers& answers);
bool holds(const std::vector<AnswerCondition>& rules, const Answers& answers);

/// Returns the interludes that come before the block with index `next` of these blocks (from block_order()),
/// in the order in which they come. With next = blocks.size(), those that come after the last block. Only
/// those of this visit.
std::vector<const Interlude*> interludes_before(const Protocol& protocol, const std::vector<Block>& blocks,
                                                std::size_t next, const Visit& visit);

/// The answer to an item as a value that rules can compare: a number if the item's answer is one.
FactorValue answer_value(const Item& item, const std::string& answer);

/// A picture of an explanation: its name in the protocol, and the path under which it is opened.
struct Picture {
  std::string path;
  Place place;
};
std::vector<Picture> pictures(const Protocol& protocol);
/// The path of a picture; relative ones belong to the folder of the protocol file.
std::string picture_path(const Protocol& protocol, const std::string& picture);

}  // namespace turnpoint::protocol
