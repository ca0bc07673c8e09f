#pragma once
#include <string>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// How the answers of a task relate to the level.
enum class AnswerKind {
  right_answer,  ///< one of the choices is right; the level determines how easy it is to find
  side,          ///< two answers: the level is below zero, or above
  presence,      ///< two answers: the level is zero (same-different: the scenes are the same), or it is not
};

struct AnswerRule {
  AnswerKind kind = AnswerKind::right_answer;
  /// side: the answer that is right above zero; presence: the answer that is right unless the level is zero
  int positive = 1;
};

/// Derives how the answers relate to this factor by evaluating the comparisons in `correct` at its ends and
/// at zero.
AnswerRule answer_rule(const Protocol& protocol, const std::string& level);

/// A typical level of this factor among the protocol's procedures (or, without procedures, its blocks): the
/// median for a factor in dB, otherwise the median magnitude of all nonzero levels. A staircase counts with
/// all levels between its limits. Returns 1 if there are no levels.
double middle_level(const Protocol& protocol, const std::string& level);

}  // namespace turnpoint::protocol
