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

/// All distinct combinations in which the task's scenes can occur: the levels of each source of trials,
/// crossed with the levels of the factors that are drawn at random.
std::vector<Combination> combinations_of(const Protocol& protocol);

/// The single expression on which everything variable in a scene depends; null if there are none or several.
const Linear* only_expression(const Scene& scene);

/// True if roving changes more than the strength. An edge defined by friction depends on the roved strength,
/// but the tones of a zone are designed without roving.
bool edge_moves_with_strength(const Scene& scene);

/// At most `most` combinations of one scene, including its extreme values. They are evenly spaced in the
/// scene's only expression, or else in each factor, so that everything between can be interpolated. If the
/// extremes alone are more than `most`, returns the first `most` combinations.
std::vector<Combination> thinned(const Scene& scene, const std::vector<Combination>& of_the_scene,
                                 std::size_t most);

/// Formats factors like `mark_mm = 164, offset_mm = -30`.
std::string format(const Factors& factors);

/// The numeric and text factors on which a scene depends.
std::set<std::string> factors_of(const Scene& scene);

}  // namespace turnpoint::protocol
