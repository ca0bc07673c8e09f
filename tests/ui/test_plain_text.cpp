#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "tests/support/catch.hpp"

namespace {

int matches(const std::string& qml, const std::regex& pattern) {
  return static_cast<int>(
      std::distance(std::sregex_iterator(qml.begin(), qml.end(), pattern), std::sregex_iterator()));
}

/// Returns the number of texts on a page that Qt might interpret as rich text. A text that can be edited has
/// to say that it is plain.
int rich_texts(const std::string& qml) {
  static const std::regex rich(R"((^|[^A-Za-z])(Text|TextEdit|TextArea|Label)\s*\{)");
  static const std::regex plain(R"(\n\s*textFormat: TextEdit\.PlainText\n)");
  return matches(qml, rich) - matches(qml, plain);
}

}  // namespace

TEST_CASE("no text on any page is interpreted as rich text", "[text]") {
  CHECK(rich_texts("Item {\n    Text { text: title }\n    Label {\n    }\n}") == 2);
  CHECK(rich_texts("PlainText { wrapMode: Text.Wrap }\nTextInput {}\nTexts { id: texts }") == 0);
  CHECK(rich_texts("TextEdit {\n    text: title\n}") == 1);
  CHECK(rich_texts("TextEdit {\n    text: title\n    textFormat: TextEdit.PlainText\n}") == 0);
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(TURNPOINT_SOURCE_DIR "/station/ui")) {
    const auto name = entry.path().filename().string();
    if (entry.path().extension() != ".qml" || name == "PlainText.qml") continue;
    ++files;
    CAPTURE(name);
    std::ifstream in(entry.path());
    CHECK(rich_texts({std::istreambuf_iterator<char>(in), {}}) == 0);
  }
  CHECK(files > 30);
}
