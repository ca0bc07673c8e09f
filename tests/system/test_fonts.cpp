#include "station/system/fonts.hpp"

#include <stdexcept>

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

TEST_CASE("the outline of a character has a width and a closed path, and a space has only a width", "[system]") {
  const auto [width, path] = turnpoint::system::outline(U'O', false);
  CHECK(width > 0.4);
  CHECK(width < 1.1);
  CHECK(path.ends_with("h "));
  CHECK(path.find(" c ") != std::string::npos);
  CHECK(turnpoint::system::outline(U' ', false).second.empty());
  CHECK(turnpoint::system::outline(U' ', false).first > 0);
  CHECK(turnpoint::system::outline(U'O', true).second != path);
  CHECK_FALSE(turnpoint::system::outline(U'\u2212', false).second.empty());
  CHECK_THROWS_AS(turnpoint::system::outline(U'\U0010FF00', false), std::runtime_error);
}
