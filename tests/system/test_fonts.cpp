#include "station/system/fonts.hpp"

#include "tests/support/catch.hpp"

using turnpoint::system::drawable;

TEST_CASE("a character can be drawn if a font has it", "[system]") {
  if (drawable(U'\U0010FF00'))
    return;  // without installed fonts, drawable() accepts every character, even this private one
  CHECK(drawable(U'a'));
  // Chinese, Japanese, Korean, Arabic, Hebrew and Devanagari: deploy/packages has fonts for them
  for (const char32_t c : U"\u6211\u3042\ud55c\u0639\u05e9\u0939") {
    CAPTURE(static_cast<unsigned>(c));
    if (c != 0) CHECK(drawable(c));
  }
}
