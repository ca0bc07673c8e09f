// Tests the catalogues of the station's texts, which have one file per language.
#include <filesystem>
#include <regex>
#include <set>
#include <stdexcept>

#include "station/system/read_file.hpp"
#include "station/terms/fault.hpp"
#include "station/texts/texts.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::set<std::string> keys_of(const std::string& language) {
  std::set<std::string> keys;
  for (const auto& [key, said] : texts::catalogue(language)) keys.insert(key);
  return keys;
}

std::multiset<std::string> places_in(const std::string& said) {
  static const std::regex place("%[0-9]");
  return {std::sregex_token_iterator(said.begin(), said.end(), place), std::sregex_token_iterator()};
}

/// All quoted words in the station's sources, and the words among them that are given to text().
struct Quoted {
  std::set<std::string> words, asked_for;
};

Quoted quoted() {
  static const std::regex word("\"([a-z_.]+)\""), use("\\btext\\(\\s*\"([a-z_.]+)\"");
  Quoted all;
  const auto add = [](const std::regex& what, const std::string& source, std::set<std::string>& to) {
    for (std::sregex_iterator found(source.begin(), source.end(), what), end; found != end; ++found)
      to.insert((*found)[1]);
  };
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(TURNPOINT_SOURCE_DIR) + "/station")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".qml") continue;
    const auto source = system::read_file(entry.path().string());
    add(word, source, all.words), add(use, source, all.asked_for);
  }
  return all;
}

}  // namespace

TEST_CASE("every language has every text, with the same places for numbers and names", "[texts]") {
  REQUIRE(texts::languages() == std::vector<std::string>{"ar", "de", "en", "es", "ja", "zh"});
  for (const auto& language : texts::languages()) {
    INFO(language);
    CHECK(keys_of(language) == keys_of("en"));
    for (const auto& [key, said] : texts::catalogue(language)) {
      INFO(key);
      CHECK_FALSE(said.empty());
      CHECK(places_in(said) == places_in(texts::text(key, "en")));
    }
  }
}

TEST_CASE("every text is used, and every text that the program requests exists", "[texts]") {
  const auto source = quoted();
  const auto keys = keys_of("en");
  CHECK(source.asked_for.size() > 40);
  for (const auto& key : source.asked_for) {
    INFO(key);
    CHECK(keys.count(key) == 1);
  }
  std::set<std::string> of_faults{"fault.safe"};
  for (const auto kind : terms::fault_kinds)
    for (const char* part : {".happened", ".safe", ".to_do"})
      of_faults.insert(std::string("fault.") + terms::name(kind) + part);
  const auto schema =
      system::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/protocol.schema.json");
  const auto goals = system::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/station/design/goals.cpp");
  for (const auto& key : keys) {
    INFO(key);
    // The designer asks for the text of every key that the schema knows, and of every goal.
    const auto last = "\"" + key.substr(key.rfind('.') + 1) + "\"";
    if (key.starts_with("design.keys.")) {
      CHECK(schema.find(last) != std::string::npos);
      continue;
    }
    if (key.starts_with("design.goals.")) {
      CHECK(goals.find("{" + last) != std::string::npos);
      continue;
    }
    CHECK((source.words.count(key) == 1 || of_faults.count(key) == 1));
  }
  for (const auto kind : terms::fault_kinds) {
    INFO(terms::name(kind));
    CHECK(keys.count(std::string("fault.") + terms::name(kind) + ".happened") == 1);
    CHECK(keys.count(std::string("fault.") + terms::name(kind) + ".to_do") == 1);
  }
}

TEST_CASE(
    "de-CH gives German, an unknown language gives English, and an unknown key is an error of the program",
    "[texts]") {
  CHECK(texts::text("proceed", "de-CH") == "Weiter");
  CHECK(texts::text("proceed", "fi") == "Continue");
  CHECK_THROWS_AS(texts::text("no_such_key", "en"), std::logic_error);
}

TEST_CASE("a phrase is said in a language that is chosen later", "[texts]") {
  const auto range =
      texts::Phrase{"check.range", "", {texts::plain("5 %1"), texts::plain("4"), texts::plain("6")}};
  const texts::Phrase phrase{"check.minutes", "", {range}};
  CHECK(texts::say(phrase, "en") == "5 %1 (4 to 6) min");
  CHECK(texts::say(phrase, "de") == "5 %1 (4 bis 6) min");
  CHECK(texts::say(texts::plain("50 %"), "ja") == "50 %");
  CHECK(texts::say({"", "", {texts::plain("main: "), {"practice", "", {}}}}, "de") == "main: \u00dcbung");
  CHECK(texts::say({"check.range", "", {texts::plain("1")}}, "en") == "1 (%2 to %3)");
  CHECK_THROWS_AS(texts::say({"no_such_key", "", {}}, "en"), std::logic_error);
}

TEST_CASE("a language is known to be spoken or not, and to have been read by a native speaker or not",
          "[texts]") {
  CHECK(texts::translation("en-GB") == texts::Translation::read);
  CHECK(texts::translation("ar") == texts::Translation::unread);
  CHECK(texts::translation("fi") == texts::Translation::none);
}

TEST_CASE("every fault says what happened, what is safe and what to do in each language", "[texts]") {
  std::set<std::string> pages;
  for (const auto kind : terms::fault_kinds)
    for (const auto& language : texts::languages()) {
      const auto text = texts::fault_text(kind, language);
      INFO(terms::name(kind) << " " << language);
      CHECK_FALSE(text.happened.empty());
      CHECK_FALSE(text.safe.empty());
      CHECK_FALSE(text.to_do.empty());
      if (language != "en") CHECK(text.happened != texts::fault_text(kind, "en").happened);
      CHECK(pages.insert(text.happened).second);  // two kinds of fault must not have the same text
    }
  CHECK(texts::fault_text(terms::FaultKind::amplifier, "fi").safe ==
        texts::fault_text(terms::FaultKind::amplifier, "en").safe);
}
