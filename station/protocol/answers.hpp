#pragma once
#include <string>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// What the answers of a task say of the level.
enum class AnswerKind {
  right_answer,  ///< one of them is right; the level says how easily it is found
  side,          ///< two answers: the level is below zero, or above
  presence,      ///< two answers: the level is zero (same-different: the pair is the same), or it is not
};

struct AnswerRule {
  AnswerKind kind = AnswerKind::right_answer;
  int positive = 1;  ///< side: the answer that is right above zero; presence: the one that is right off zero
};

/// How the answers relate to this factor, from the comparisons of `correct` at its ends and at zero.
AnswerRule answer_rule(const Protocol& protocol, const std::string& level);

/// The middle of the levels that the protocol's procedures present of this factor (without procedures: its
/// blocks): for a factor in dB their median, for any other that of their magnitudes without zero. A staircase
/// counts with everything between its limits. 1 where there are none.
double middle_level(const Protocol& protocol, const std::string& level);

}  // namespace turnpoint::protocol
