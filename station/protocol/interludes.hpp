#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// What a participant has answered so far, and the scores: "about-you.age" or "practice.accuracy", with the
/// value. The newest value counts.
using Answers = std::map<std::string, FactorValue>;

/// False if there is no such answer or score.
bool holds(const AnswerCondition& rule, const Answers& answers);
bool holds(const std::vector<AnswerCondition>& rules, const Answers& answers);

/// What comes before the block `next` of these blocks (from block_order()), in the order in which it comes.
/// With next = blocks.size(), what comes after the last block.
std::vector<const Interlude*> interludes_before(const Protocol& protocol, const std::vector<Block>& blocks,
                                                std::size_t next);

/// The answer to an item as a value that rules can compare: a number if the item's answer is one.
FactorValue answer_value(const Item& item, const std::string& answer);

/// Names the pictures of all explanations, each with the path under which it is opened.
struct Picture {
  std::string path;
  Place place;
};
std::vector<Picture> pictures(const Protocol& protocol);
/// The path of a picture; relative ones belong to the folder of the protocol file.
std::string picture_path(const Protocol& protocol, const std::string& picture);

}  // namespace turnpoint::protocol
