#pragma once
#include <functional>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// Finds texts of the protocol with characters that cannot be drawn: one problem for each key, at its line,
/// with all such characters. `drawable` says whether a character (a Unicode code point) can be drawn on this
/// machine. It is not asked for Latin letters, which every font of the station has, nor for characters that
/// are never drawn, such as marks of the direction of writing.
std::vector<core::Problem> undrawable(const Protocol& protocol,
                                      const std::function<bool(char32_t)>& drawable);

}  // namespace turnpoint::protocol
