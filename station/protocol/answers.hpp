#pragma once
#include <string>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// How the answers of a task relate to the level.
enum class AnswerKind {
  right_answer,  ///< one of the choices is right; the level determines how easy it is to find
  side,          ///< two answers: one is right for levels below zero, the other for levels above
  /// two answers: one is right if the level is zero (same-different: the scenes are the same), the other if
  /// not
  presence,
};

struct AnswerRule {
  AnswerKind kind = AnswerKind::right_answer;
  /// for `side` the answer that is right above zero; for `presence` the answer that is right unless the level
  /// is zero
  int positive = 1;
};

/// Finds out how the answers relate to this factor by evaluating the comparisons of `correct` at zero and at
/// the ends of the factor's range.
AnswerRule answer_rule(const Protocol& protocol, const std::string& level);

/// A typical level of this factor among the protocol's procedures (or, without procedures, its blocks): the
/// median for a factor in dB, otherwise the median magnitude of all nonzero levels. A staircase counts with
/// all levels between its limits. Returns 1 if there are no levels.
double middle_level(const Protocol& protocol, const std::string& level);

}  // namespace turnpoint::protocol
