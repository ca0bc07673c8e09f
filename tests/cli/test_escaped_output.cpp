#include <fstream>
#include <iterator>
#include <sstream>

#include "station/cli/escaped_output.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

std::string escaped(const std::string& text) {
  std::ostringstream to;
  turnpoint::cli::EscapedOutput(to) << text << std::flush;
  return to.str();
}

}  // namespace

TEST_CASE("control characters are shown instead of sent to the terminal, and no other text is touched",
          "[text]") {
  CHECK(escaped("\x1b[31mred\x07\r\x7f\x08") == "\\x1b[31mred\\x07\\x0d\\x7f\\x08");
  CHECK(escaped("\xc2\x9b[31m") == "\\u009b[31m");  // U+009B is a single character that acts like ESC [
  const std::string plain = "line\n\t\xc2\xb5m \xc3\xbc \xe3\x81\xaa\xe3\x82\x81 \xf0\x9f\x99\x82 \xc2\xa0.";
  CHECK(escaped(plain) == plain);
  CHECK(escaped("cut \xc2") == "cut \xc2");
}

TEST_CASE("a protocol's title and keys reach the terminal without their escape sequences", "[text]") {
  const TemporaryFolder folder;
  const auto protocol = folder / "p.toml";
  const std::string source = TURNPOINT_SOURCE_DIR;
  std::ifstream demo(source + "/protocols/demo.toml");
  const std::string text{std::istreambuf_iterator<char>(demo), {}};
  const auto title = text.find("title = \"Demo");
  REQUIRE(title != std::string::npos);
  const auto said = [&](const std::string& hostile) {
    std::ofstream(protocol) << hostile;
    Child child({TURNPOINT, "check", protocol, "--rig", source + "/tests/support/thin_plate.toml"});
    REQUIRE(child.ends_within(60000));
    return child.said();
  };
  const auto titled = said(std::string(text).insert(title + 9, "\\u001b]0;owned\\u0007"));
  CHECK(titled.find("\\x1b]0;owned\\x07Demo") != std::string::npos);
  CHECK(titled.find('\x1b') == std::string::npos);
  const auto keyed = said(std::string(text).insert(title, "\"\\u001b[2J\" = 1\n"));
  CHECK(keyed.find("\\x1b[2J") != std::string::npos);
  CHECK(keyed.find('\x1b') == std::string::npos);
}
