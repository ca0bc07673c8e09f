// What the text editor suggests at the cursor, which is written here as "|".
#include <algorithm>
#include <string>
#include <vector>

#include "station/design/completion.hpp"
#include "station/design/draft.hpp"
#include "station/system/read_file.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using Words = std::vector<std::string>;

namespace {

const design::Schema& schema_of_protocols() {
  static const design::Schema schema(
      system::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/protocol.schema.json"));
  return schema;
}

design::Completion at_cursor(std::string text) {
  const auto at = text.find('|');
  REQUIRE(at != std::string::npos);
  text.erase(at, 1);
  return design::complete(schema_of_protocols(), text, at);
}

Words suggested(const std::string& text) {
  Words words;
  for (const auto& one : at_cursor(text).suggestions) words.push_back(one.word);
  return words;
}

/// The text after the first suggestion was taken.
std::string taken(std::string text) {
  const auto made = at_cursor(text);
  REQUIRE_FALSE(made.suggestions.empty());
  const auto at = text.find('|');
  return text.replace(made.from, at + 1 - made.from, made.suggestions.front().insert);
}

bool has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

TEST_CASE("a begun key is completed with the keys of its table", "[design]") {
  CHECK(suggested("[timing]\ndead|") == Words{"deadline_s"});
  CHECK(taken("[timing]\ndead|") == "[timing]\ndeadline_s = ");
  CHECK(taken("[timing]\niti_s = 1\ndead|\n\n[[block]]") ==
        "[timing]\niti_s = 1\ndeadline_s = \n\n[[block]]");
  CHECK(suggested("[timing]\nfriction|").empty());
}

TEST_CASE("an empty line offers every key that the table does not have yet", "[design]") {
  const auto words = suggested("[protocol]\nid = \"x\"\n|\ntitle = \"T\"\n[random]\nseed = 1\n");
  CHECK(words == Words{"version", "languages"});
}

TEST_CASE("a value is completed with the words that the schema allows", "[design]") {
  const auto all = suggested("[task]\nkind = |");
  CHECK(has(all, "2ifc"));
  CHECK(has(all, "adjustment"));
  CHECK(taken("[task]\nkind = \"adj|") == "[task]\nkind = \"adjustment\"");
  CHECK(taken("[task]\nkind = \"adj|\"\n") == "[task]\nkind = \"adjustment\"\n");
  CHECK(taken("[task]\nkind = \"adj|\n[timing]\n") == "[task]\nkind = \"adjustment\"\n[timing]\n");
  CHECK(suggested("[[block]]\npractice = |") == Words{"true", "false"});
}

TEST_CASE("tables are completed in headers", "[design]") {
  CHECK(taken("[tim|") == "[timing]");
  CHECK(taken("[[pro|") == "[[procedure]]");
  CHECK(taken("[sce|") == "[scene.");
}

TEST_CASE("names of the file are suggested where a key refers to them, wherever they are defined",
          "[design]") {
  const std::string below =
      "\n[scene.flat]\nboundary_mm = 150\n[scene.edge]\nbase = \"flat\"\n"
      "[[procedure]]\nname = \"track\"\n[[block]]\nname = \"main\"\nprocedures = [";
  CHECK(suggested("[task]\nstandard = |" + below) == Words{"flat", "edge"});
  CHECK(suggested("[task]\nintervals = [\"flat\", \"|" + below) == Words{"flat", "edge"});
  CHECK(suggested(below + "\"t|") == Words{"track"});
}

TEST_CASE("inline tables and lists of tables are completed with their own keys", "[design]") {
  CHECK(suggested("[scene.edge]\nzone = { fr|") == Words{"from_mm", "friction"});
  CHECK(taken("[scene.edge]\nzone = { from_mm = 60, to|") == "[scene.edge]\nzone = { from_mm = 60, tones = ");
  CHECK(has(suggested("[task]\nchoices = [\n  { id = \"1\", |"), "label"));
  // an inline table whose bracket is missing ends with its line
  CHECK(suggested("[scene.edge]\nzone = { from_mm = 60\n[timing]\ndead|") == Words{"deadline_s"});
}

TEST_CASE("questions are written in the languages of the study", "[design]") {
  CHECK(suggested("[protocol]\nlanguages = [\"en\", \"de\"]\n[task]\nquestion = { en = \"x\", |") ==
        Words{"de"});
}

TEST_CASE("nothing is suggested in comments, in free text, and after a value", "[design]") {
  CHECK(suggested("[timing]\n# dead|").empty());
  CHECK(suggested("[protocol]\ntitle = \"dead|").empty());
  CHECK(suggested("[timing]\niti_s = { uniform = [1, 2] }|").empty());
  CHECK(at_cursor("|").suggestions.size() == 1);  // the key "format"
}

TEST_CASE("the next version is one higher in its last number", "[design]") {
  CHECK(design::next_version("1") == "2");
  CHECK(design::next_version("1.9") == "1.10");
  CHECK(design::next_version("2.0-beta9b") == "2.0-beta10b");
  CHECK(design::next_version("99") == "100");
  CHECK(design::next_version("007") == "008");
  CHECK(design::next_version("draft") == "draft-2");
}
