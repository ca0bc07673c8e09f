#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// How the answers of a task relate to the level.
enum class AnswerKind {
  right_answer,  ///< one of the choices is right; the level determines how easy it is to find
  side,          ///< two answers: one is right for levels below zero, the other for levels above
  /// two answers: one is right if the level is zero, the other if it is not (for same-different: zero means
  /// that both scenes are the same)
  presence,
  category,  ///< the level decides which of the answers is right (identification)
};

struct AnswerRule {
  AnswerKind kind = AnswerKind::right_answer;
  /// index of a choice. For `side`: the answer that is right for levels above zero. For `presence`: the
  /// answer that is right for every level except zero
  int positive = 1;
  /// for `category`: for each choice, the mean of the presented levels at which it is right
  std::vector<double> categories = {};
};

/// Finds out how the answers relate to this factor by evaluating the comparisons of `correct` at zero, at the
/// ends of the factor's range, and at the levels that are presented.
AnswerRule answer_rule(const Protocol& protocol, const std::string& level);

/// True if the participant may answer while the surface moves.
bool explored(const Task& task);

/// The earliest and the latest time from response_zero to the end of the last interval, in s; empty if they
/// are not known before the trial.
struct StimulusEnd {
  double earliest_s = 0, latest_s = 0;
};
std::optional<StimulusEnd> stimulus_end(const Protocol& protocol);

/// True if answers are ratings or numbers, none of which is right or wrong.
inline bool judges(const Task& task) { return task.rating || task.value; }

/// Rounds an answer to the decimals of the task. Empty if the answer is out of range, or if a typed number
/// has more decimals than the task allows.
std::optional<double> accepted(const ValueAnswer& answer, double given);

/// True if the factor's levels lie on both sides of zero.
bool two_sided(const Protocol& protocol, const std::string& level);

/// A typical level of the factor `level` in the protocol's procedures, or in its blocks if it has no
/// procedures. For a factor in dB it is the median of all levels, otherwise the median magnitude of all
/// nonzero levels. For a staircase, evenly spaced levels between its limits are used. Returns 1 if there are
/// no levels.
double middle_level(const Protocol& protocol, const std::string& level);

}  // namespace turnpoint::protocol
