#pragma once
// The best strategies of an observer who uses only one cue, found by trying all of them.
#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::tests {

/// index of the cue `loudness`, which is compared in dB
inline constexpr std::size_t loudness = 1;

/// A rule by which an observer answers. Returns one answer, or several that look equally good, among which
/// the observer guesses.
using Strategy = std::function<std::vector<int>(const std::vector<double>&)>;

/// Counts trials that look the same: the key is the cue's value in each interval, together with the right
/// answer.
using Shown = std::map<std::pair<std::vector<double>, int>, double>;

/// Returns the difference up to which two values of a cue count as equal.
double grain_of(std::size_t cue, const std::vector<double>& values);
/// Returns a strategy that gives the answer `inside` from the lowest value up to the highest value, and the
/// other of two answers elsewhere. If `distance` is set, the value is the difference between two intervals.
Strategy band(double lowest, double highest, int inside, bool distance);
/// Returns possible criteria for a cue: the places between different values, and one below and one above all
/// values. `values` has each value and its weight. If there are more than `most` places, returns those that
/// divide the weight equally, and those beside a value that occurs often.
std::vector<double> cuts_of(std::vector<std::pair<double, double>> values, double grain, std::size_t most);

/// Returns the accuracy that a strategy reaches on average in these trials.
double expected(const Strategy& strategy, const Shown& shown);
/// Finds the best pair of criteria. Tries all pairs of places between different values (about 80 places), and
/// each of the two answers for values between the criteria. Values that differ by less than `grain` count as
/// equal. If `distance` is set, the value is the difference between the two intervals.
Strategy best_cuts(const Shown& shown, double grain, bool distance);
/// Finds the best ranges of a cue for more than two answers. Tries all places for the end of each further
/// range, and all answers in it.
Strategy best_parts(const Shown& shown, double grain, int answers);
/// Finds the best rule by which an observer can choose one of several intervals from the values of this cue.
Strategy best_choice(const Shown& shown, std::size_t cue, protocol::TaskKind kind);

}  // namespace turnpoint::tests
