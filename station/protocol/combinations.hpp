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

/// At most `most` of one scene's combinations: those with an extreme value of every factor first, then an
/// even choice.
std::vector<Combination> thinned(const std::vector<Combination>& of_one_scene, std::size_t most);

/// `mark_mm = 164, offset_mm = -30`.
std::string format(const Factors& factors);

/// The numeric and text factors on which a scene depends.
std::set<std::string> factors_of(const Scene& scene);

}  // namespace turnpoint::protocol
