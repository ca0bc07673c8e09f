#include "station/protocol/glyphs.hpp"

#include <algorithm>

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
  const auto drawn = protocol::drawn_with(protocol, [&](char32_t c) {
    asked += c;
    return c != U'\ud55c' && c != U'\U0010FF00';
  });
  const auto& found = drawn.problems;
  REQUIRE(found.size() == 1);
  CHECK(drawn.languages == protocol.languages);
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
  const auto drawn = protocol::drawn_with(protocol, [](char32_t c) { return c >= 0x3000; });
  CHECK(drawn.problems.empty());
  CHECK(drawn.other_languages.empty());
}

TEST_CASE("a language that no font can draw is not offered, and does not hinder the others", "[protocol]") {
  const auto protocol = protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/demo.toml");
  REQUIRE(protocol.languages.size() > 1);
  REQUIRE(protocol.languages.front() == "en");
  const auto latin_only = [](char32_t c) { return c < 0x3000; };
  const auto drawn = protocol::drawn_with(protocol, latin_only);
  CHECK(drawn.problems.empty());
  CHECK(std::find(drawn.languages.begin(), drawn.languages.end(), "en") != drawn.languages.end());
  CHECK(std::find(drawn.languages.begin(), drawn.languages.end(), "ja") == drawn.languages.end());
  REQUIRE_FALSE(drawn.other_languages.empty());
  CHECK(drawn.languages.size() + drawn.other_languages.size() == protocol.languages.size());
  for (const auto& other : drawn.other_languages) {
    CHECK(other.place.line > 0);
    CHECK(core::say(other.what, "en").find("U+") != std::string::npos);
  }
  // with every font, every language is offered
  CHECK(protocol::drawn_with(protocol, [](char32_t) { return true; }).languages == protocol.languages);
}

TEST_CASE("a study whose languages no font can draw has a problem", "[protocol]") {
  auto text = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/demo.toml");
  const auto protocol = protocol::parse(text, "demo.toml");
  protocol::Protocol foreign = protocol;
  foreign.languages = {"ja"};
  const auto drawn = protocol::drawn_with(foreign, [](char32_t c) { return c < 0x3000; });
  CHECK(drawn.languages.empty());
  CHECK_FALSE(drawn.problems.empty());
}
