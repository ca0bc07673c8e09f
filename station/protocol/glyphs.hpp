#pragma once
#include <functional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// What of a protocol this machine can draw with its fonts.
struct Drawable {
  std::vector<std::string> languages;  ///< those of the protocol's languages in which all texts can be drawn
  /// for each of the other languages, where its first such text is, and all characters that no font has
  std::vector<core::Problem> other_languages;
  /// Texts with such characters that are shown in every language: one problem for each key. If no language can be drawn,
  /// the problems of all languages.
  std::vector<core::Problem> problems;
};
/// `drawable` says whether a character (a Unicode code point) can be drawn on this machine. It is not asked for Latin
/// letters, which every font of the station has, nor for characters that are never drawn, such as marks of the direction
/// of writing.
Drawable drawn_with(const Protocol& protocol, const std::function<bool(char32_t)>& drawable);

}  // namespace turnpoint::protocol
