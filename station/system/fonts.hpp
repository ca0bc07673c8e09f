#pragma once

namespace turnpoint::system {

/// Returns true if an installed font has a shape for this character (a Unicode code point), as fontconfig
/// says. Also true if no font is installed at all: such a machine has no screen to draw on.
bool drawable(char32_t character);

}  // namespace turnpoint::system
