#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// Finds out how the answers relate to this factor by evaluating the comparisons of `correct` over the whole
/// range of the factor and at the levels that are presented.
AnswerRule answer_rule(const Protocol& protocol, const std::string& level);

/// The same rule; taken from the meanings of a protocol that has been read, without computing it again.
AnswerRule answer_rule_of(const Protocol& protocol, const std::string& level);

/// Decides what the trials of each level factor measure; see Meaning. The decision looks at the protocol
/// only.
std::vector<Meaning> meanings_of(const Protocol& protocol);

/// The meanings of a file with several tasks: those of each, with its name.
std::vector<Meaning> meanings_of_tasks(const Protocol& protocol);

/// In 2ifc, the scene of the interval with this number (0 or 1) as the protocol lists them, by which
/// `correct` names it.
std::string scene_of(const Task& task, int number);

/// True if the answers can be right or wrong.
bool scored(const Task& task);

/// The number of answers that the participant can choose from: the choices, and then `unsure`, if the task
/// has it.
int answer_count(const Task& task);

/// The id of the answer with this index; "" if there is none.
std::string answer_id(const Task& task, int index);

/// The index of the answer with this id; empty if there is none.
std::optional<int> answer_index(const Task& task, const std::string& id);

/// What a procedure learns from an answer: its id, and whether it was right, if it can be.
procedure::Answer learned_from(const procedure::Spec& spec, const std::string& response,
                               const std::optional<bool>& correct);

/// The parts of an interval that the task lists.
std::vector<Part> parts_of(const Task& task, const std::vector<std::string>& interval);

/// The parts of a trial with these intervals, a list for each. What comes before the first interval is at the
/// beginning of the first list, and the silence after it before the next part.
std::vector<std::vector<Part>> parts_of_trial(const Task& task,
                                              const std::vector<std::vector<std::string>>& intervals);

/// All parts that the task presents, in the order of the task: what comes before the intervals, and those of
/// its intervals, or of standard and target.
std::vector<Part> parts_of(const Task& task);

/// The parts that can be the last one of a trial: one for each order of the intervals, without repetition.
std::vector<Part> last_parts(const Task& task);

/// All lengths and silences of the stimuli of a trial.
std::vector<Linear> stimulus_times(const Task& task);

/// The length of a part; null if it lasts until the answer.
const Linear* length_of(const Task& task, const Part& part);

/// The shortest and the longest time for which a part lasts, in s; 0 if the file does not say it. A part that
/// lasts until the answer lasts for explore_s of [timing] at most, which is then both.
std::pair<double, double> length_range_s(const Protocol& protocol, const Part& part);

/// True if the participant may answer while the surface moves: in the last part of the last interval.
bool explored(const Task& task);

/// The earliest and the latest time from response_zero to the end of the last interval, in s, whichever part
/// is the last one; empty if they are not known before the trial.
struct StimulusEnd {
  double earliest_s = 0, latest_s = 0;
};
std::optional<StimulusEnd> stimulus_end(const Protocol& protocol);
/// The same for these values of the factors on which the lengths of last_parts() and the foreperiod depend.
std::optional<StimulusEnd> stimulus_end(const Protocol& protocol, const Factors& factors);

/// The time of a change to the second scene, from the onset of its interval, and the length of that interval,
/// in s: at those values of the factors at which the change comes latest before the end, or furthest after
/// it. Empty if no interval has a foreperiod and a known length.
struct LatestChange {
  double change_s = 0, whole_s = 0;
};
std::optional<LatestChange> latest_change(const Protocol& protocol);

/// About how long a trial of the task lasts that is answered `answer_s` after its stimuli: the get-ready cue,
/// the stimuli, the answer and the pause.
double quick_trial_s(const Protocol& protocol, double answer_s);

/// True if answers are ratings or numbers, none of which is right or wrong.
inline bool judges(const Task& task) { return task.rating || task.value; }

/// Rounds an answer to the decimals of the task. Empty if the answer is out of range, or if a typed number
/// has more decimals than the task allows.
std::optional<double> accepted(const ValueAnswer& answer, double given);

/// True if the factor's levels lie on both sides of zero.
bool two_sided(const Protocol& protocol, const std::string& level);

/// A typical level of the factor `level` in the protocol's procedures, or in its blocks if it has no
/// procedures. If the right answer changes at a cut, it is the median distance from the cut. Otherwise, for a
/// factor in dB, it is the median of all levels, and for any other the median magnitude of all nonzero
/// levels. For a staircase, evenly spaced levels between its limits are used. Returns 1 if there are no
/// levels.
double middle_level(const Protocol& protocol, const std::string& level);

/// The same level; taken from the meanings of a protocol that has been read, without computing it again.
double middle_level_of(const Protocol& protocol, const std::string& level);

}  // namespace turnpoint::protocol
