#pragma once
#include <string>
#include <vector>

#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

/// A scene with values for the factors that it depends on.
struct Combination {
  std::string scene, block;
  Factors factors;
};

/// Returns all different combinations of factors with which the task's scenes can be presented: the levels of
/// each source of trials, crossed with the levels of the factors that are drawn at random.
std::vector<Combination> combinations_of(const Protocol& protocol);

/// The scene's expression that contains factors, if exactly one expression does; otherwise null.
const Linear* only_expression(const Scene& scene);

/// True if the random change of the scene's strength (rove_dB) also moves its edge. This is the case for an
/// edge defined by friction. It is not the case in a zone, because the tones of a zone are designed without
/// this change.
bool edge_moves_with_strength(const Scene& scene);

/// Chooses at most `most` combinations of one scene, including the extreme values, so that results for the
/// others can be interpolated. They are evenly spaced in the value of only_expression(), or in each factor if
/// only_expression() is null. If the extremes alone are more than `most` combinations, returns the first
/// `most` of them.
std::vector<Combination> thinned(const Scene& scene, const std::vector<Combination>& of_the_scene,
                                 std::size_t most);

/// Formats factors like `mark_mm = 164, offset_mm = -30`.
std::string format(const Factors& factors);

/// Says in which scene, in which block and at which factors something is the case.
core::Phrase in_case(const Combination& combination, core::Phrase what);
/// Adds in how many other cases the same is true. `cases` counts the first case, too.
core::Phrase counted(core::Phrase first, int cases);

/// The numeric and text factors on which a scene depends.
std::set<std::string> factors_of(const Scene& scene);

}  // namespace turnpoint::protocol
