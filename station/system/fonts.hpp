#pragma once
#include <string>
#include <utility>

namespace turnpoint::system {

/// Returns true if an installed font has a shape for this character (a Unicode code point), as fontconfig
/// says. Also true if no font is installed at all: such a machine has no screen to draw on.
bool drawable(char32_t character);

/// Returns the shape of a character in the station's font or, if that has none, in another installed font: how far the
/// next character is from it, and its path in the operators of PDF ("x y m", "x y l", "x y x y x y c", "h"). Both are in
/// units of the font size, with y upwards. A character without a shape, such as a space, has no path. Throws
/// std::runtime_error if no font has the character.
std::pair<double, std::string> outline(char32_t character, bool bold);

}  // namespace turnpoint::system
