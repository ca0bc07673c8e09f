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
  /// index of a choice: for `side`, the answer that is right for levels above zero; for `presence`, the
  /// answer that is right for every level but zero
  int positive = 1;
};

/// Finds out how the answers relate to this factor by evaluating the comparisons of `correct` at zero and at
/// the ends of the factor's range.
AnswerRule answer_rule(const Protocol& protocol, const std::string& level);

/// A typical level of the factor `level` in the protocol's procedures (or in its blocks, if there are no
/// procedures): for a factor in dB the median, otherwise the median magnitude of all nonzero levels. For a
/// staircase, evenly spaced levels between its limits are used. Returns 1 if there are no levels.
double middle_level(const Protocol& protocol, const std::string& level);

}  // namespace turnpoint::protocol
