#pragma once
#include <string>
#include <vector>

#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

/// A scene with values of the factors that it depends on.
struct Combination {
  std::string scene, block;
  Factors factors;
};

/// Every combination in which the task's scenes can occur, each once: levels of each origin of trials crossed
/// with the levels of the factors that are drawn.
std::vector<Combination> combinations_of(const Protocol& protocol);

/// The one expression on which everything that varies in a scene depends; null where there are none or
/// several.
const Linear* only_expression(const Scene& scene);

/// Whether roving moves more than the strength: an edge by friction is found for the strength that is drawn,
/// but a zone's tones are designed without roving.
bool edge_moves_with_strength(const Scene& scene);

/// At most `most` of one scene's combinations, extreme values included: even steps of the scene's only
/// expression, else of each factor, so that everything between can be interpolated. If the extremes alone
/// are more than `most`, returns the first `most` combinations.
std::vector<Combination> thinned(const Scene& scene, const std::vector<Combination>& of_the_scene,
                                 std::size_t most);

/// `mark_mm = 164, offset_mm = -30`.
std::string format(const Factors& factors);

/// The numeric and text factors on which a scene depends.
std::set<std::string> factors_of(const Scene& scene);

}  // namespace turnpoint::protocol
