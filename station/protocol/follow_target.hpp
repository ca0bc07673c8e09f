#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "station/protocol/scene.hpp"
#include "station/scene/scene.hpp"

namespace turnpoint::protocol {

/// Returns what a scene's gain follows as numbers, for these values of the factors. Throws
/// std::invalid_argument for values that are not possible together, or for a factor without a number.
scene::FollowTarget follow_target(const Follow& follow, const Factors& factors,
                                  const std::optional<std::pair<double, double>>& speed_mm_s);

/// Number of samples of a noise that comes again after this length: 8 for each of its shortest cycles. 0 if
/// they are too many for a pattern, or if no whole number of cycles in this length has power.
int noise_samples(const Noise& noise, double length_m);

/// All expressions of what a scene follows. The pointers point into it.
std::vector<const Linear*> expressions_of(const Follow& follow);

/// Everything that the expressions can set, in the same order for scenes with the same kinds of parts; empty
/// for what is not said.
std::vector<std::optional<double>> followed_numbers(const scene::FollowTarget& target);

}  // namespace turnpoint::protocol
