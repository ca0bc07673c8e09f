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

/// The word by which the protocol file calls a kind of interlude.
const char* name(InterludeKind kind);

/// True if the rule holds; false if the answer or score that it names does not exist yet.
bool holds(const AnswerCondition& rule, const Answers& answers);
bool holds(const std::vector<AnswerCondition>& rules, const Answers& answers);

/// Returns the interludes (questionnaires, explanations, ...) of this visit that come before block number
/// `next` of `blocks` (from block_order()), in order. With next = blocks.size(), returns those after the last
/// block.
std::vector<const Interlude*> interludes_before(const Protocol& protocol, const std::vector<Block>& blocks,
                                                std::size_t next, const Visit& visit);

/// The answer to an item as a value that rules can compare: a number if the answer is a number.
FactorValue answer_value(const Item& item, const std::string& answer);

/// A picture of an explanation: the path under which it is opened, and the place of its name in the protocol
/// file.
struct Picture {
  std::string path;
  Place place;
};
std::vector<Picture> pictures(const Protocol& protocol);
/// The path of a picture; a relative path starts from the folder of the protocol file.
std::string picture_path(const Protocol& protocol, const std::string& picture);

}  // namespace turnpoint::protocol
