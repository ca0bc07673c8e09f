#include "station/protocol/glyphs.hpp"

#include "station/core/read_file.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::string source(const std::string& title) {
  auto text = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/friction-2ifc.toml");
  const auto at = text.find("\nen ", text.find("[protocol.title]"));
  const auto inline_at = text.find("title = ");
  const auto line = at != std::string::npos ? at + 1 : inline_at;
  REQUIRE(line != std::string::npos);
  const auto quote = text.find('"', line);
  return text.replace(quote + 1, text.find('"', quote + 1) - quote - 1, title);
}

}  // namespace

TEST_CASE("a text with characters that no font can draw is named with its line and these characters",
          "[protocol]") {
  const auto protocol =
      protocol::parse(source("Gr\u00f6\u00dfe \ud55c\uae00 \U0010FF00\ud55c"), "study.toml");
  std::u32string asked;
  const auto found = protocol::undrawable(protocol, [&](char32_t c) {
    asked += c;
    return c != U'\ud55c' && c != U'\U0010FF00';
  });
  REQUIRE(found.size() == 1);
  CHECK(found[0].place.file == "study.toml");
  CHECK(found[0].place.line > 0);
  const auto said = core::say(found[0].what, "en");
  const auto says = [&](const char* words) { return said.find(words) != std::string::npos; };
  CHECK(says("title"));
  CHECK(says("\ud55c (U+D55C), \U0010FF00 (U+10FF00)"));
  CHECK_FALSE(says("\uae00"));
  CHECK(asked.find(U'\u00f6') == std::u32string::npos);
}

TEST_CASE("marks that have no shape are not looked for in fonts", "[protocol]") {
  const auto protocol = protocol::parse(source("a\u2060b\u200fc\ufe0f"), "study.toml");
  CHECK(protocol::undrawable(protocol, [](char32_t c) { return c >= 0x3000; }).empty());
}
