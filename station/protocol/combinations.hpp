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

/// All different combinations in which scenes of the task can occur: the levels of each source of trials,
/// crossed with the levels of the factors that are drawn at random.
std::vector<Combination> combinations_of(const Protocol& protocol);

/// The expression of the scene that contains factors, if there is exactly one; otherwise null.
const Linear* only_expression(const Scene& scene);

/// True if roving the scene's strength also moves its edge. That is so for an edge defined by friction,
/// except in a zone, whose tones are designed without roving.
bool edge_moves_with_strength(const Scene& scene);

/// At most `most` combinations of one scene, with the extreme values among them, so that the others can be
/// interpolated. They are evenly spaced in the value of only_expression(), or in each factor if that is null.
/// If there are more extremes than `most`, returns the first `most` combinations.
std::vector<Combination> thinned(const Scene& scene, const std::vector<Combination>& of_the_scene,
                                 std::size_t most);

/// Formats factors like `mark_mm = 164, offset_mm = -30`.
std::string format(const Factors& factors);

/// The numeric and text factors on which a scene depends.
std::set<std::string> factors_of(const Scene& scene);

}  // namespace turnpoint::protocol
