// Tests that changing single values in a TOML text leaves all other bytes as they are.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/read_file.hpp"
#include "station/view/document.hpp"
#include "station/view/draft.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using view::Document;
using view::Part;
using view::Path;

namespace {

const std::string awkward =
    "# a comment = \"not a key\"\n"
    "a = 1            # behind a value\n"
    "'quoted key' = \"x # y = 3\" # z\n"
    "\"with \\\"escapes\\\"\" = 'it\\s'\n"
    "multi = \"\"\"\n[not.a.table]\nk = \"1\" \\\"\"\" \"\"\"\"\"\n"
    "raw = '''\n]] }} ''\n'''\n"
    "list = [ # first\n  1.5e3, # one\n  [ 'a', \"]\" ],\n  { x = 1, y.z = [2] }, # last\n]\n"
    "empty = []\nnone = {}\n"
    "when = 1979-05-27 07:32:00 # a date with a space\n"
    "dotted.key.deep = true\n"
    "dotted.\"key\".other = +1_000\n"
    "\n[ table . sub ] # header\n  indented\t=\t0x1F\n"
    "[[items]]\nname = 'one'\n[items.below]\nv = 1\n\n\n# about two\n[[items]]\nname = \"two\" # "
    "2\n[[items.deep]]\nw = -inf\n"
    "[table]\nlate = 2\n[last]";

std::string with_crlf(const std::string& text) {
  std::string all;
  for (const char c : text) all += c == '\n' ? "\r\n" : std::string(1, c);
  return all;
}

struct Text {
  std::string name, text;
};

std::vector<Text> all_texts() {
  std::vector<Text> all{{"awkward", awkward},
                        {"awkward, CRLF", with_crlf(awkward)},
                        {"awkward, BOM", "\xEF\xBB\xBF" + awkward}};
  for (const char* folder : {"/protocols", "/tests/ui", "/deploy/rigs", "/tests/protocol/corpus"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::string(TURNPOINT_SOURCE_DIR) + folder))
      if (entry.path().extension() == ".toml") {
        auto text = core::read_file(entry.path().string());
        try {
          core::parse_toml(text, "");
        } catch (const core::BadInput&) {
          continue;  // some files of the corpus are not valid TOML
        }
        all.push_back({entry.path().string(), text});
        if (std::string(folder) == "/protocols")
          all.push_back({entry.path().string() + ", CRLF", with_crlf(text)});
      }
  return all;
}

void each_value(const Part& part, Path& path, const std::function<void(const Path&, const Part&)>& visit) {
  const auto kind = part.kind;
  if (kind == Part::Kind::scalar || kind == Part::Kind::array || kind == Part::Kind::inline_table)
    visit(path, part);
  for (const auto& below : part.parts) {
    path.push_back(below.name);
    each_value(below, path, visit);
    path.pop_back();
  }
}

/// Returns the value at a path. It is found by the TOML parser, not by the code under test.
const core::Value* parsed(const core::Value& document, const Path& path) {
  const auto* value = &document;
  for (const auto& name : path) {
    if (value->kind == core::Value::Kind::array) {
      value = &value->items.at(std::stoul(name));
      continue;
    }
    const auto* entry = value->find(name);
    if (entry == nullptr) return nullptr;
    value = &entry->value;
  }
  return value;
}

bool same(const core::Value& a, const core::Value& b) {
  const bool numbers = a.number == b.number || (a.number != a.number && b.number != b.number);
  return a.kind == b.kind && a.boolean == b.boolean && a.integer == b.integer && numbers &&
         a.string == b.string &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same) &&
         std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(),
                    [](const auto& x, const auto& y) { return x.key == y.key && same(x.value, y.value); });
}

std::size_t leaves(const core::Value& value) {
  std::size_t count = value.kind != core::Value::Kind::table && value.kind != core::Value::Kind::array;
  for (const auto& item : value.items) count += leaves(item);
  for (const auto& entry : value.entries) count += leaves(entry.value);
  return count;
}

}  // namespace

TEST_CASE("every value is found where the parser of TOML finds it, and is itself when it is set to itself",
          "[document]") {
  const auto all = all_texts();
  REQUIRE(all.size() > 50);
  for (const auto& [name, text] : all) {
    INFO(name);
    const Document document(text, "f.toml");
    const auto truth = core::parse_toml(text, "f.toml");
    std::size_t scalars = 0;
    Path path;
    each_value(document.root(), path, [&](const Path& at, const Part& part) {
      INFO(Catch::Detail::stringify(at));
      scalars += part.kind == Part::Kind::scalar;
      const auto* expected = parsed(truth, at);
      REQUIRE(expected != nullptr);
      REQUIRE(same(core::value_of(part), *expected));
      if (at.size() == 1) REQUIRE(part.line == truth.find(at[0])->place.line);
      REQUIRE(document.with(at, document.written(at)) == text);
    });
    CHECK(scalars == leaves(truth));
  }
}

TEST_CASE("a changed value is the only change, and undo gives the bytes from before", "[document]") {
  for (const auto& [name, text] : all_texts()) {
    INFO(name);
    const Document document(text, "f.toml");
    Path path;
    int i = 0;
    each_value(document.root(), path, [&](const Path& at, const Part& part) {
      if (++i % 7 != 0 && name != "awkward") return;
      INFO(Catch::Detail::stringify(at));
      const std::string value = "[ 'changed', 1 ]";
      view::Draft draft(text, "f.toml");
      draft.change(document.with(at, value));
      REQUIRE(draft.document() != nullptr);
      CHECK(draft.text().substr(0, part.value.begin) == text.substr(0, part.value.begin));
      CHECK(draft.text().substr(part.value.begin, value.size()) == value);
      CHECK(draft.text().substr(part.value.begin + value.size()) == text.substr(part.value.end));
      const auto read = core::parse_toml(draft.text(), "");
      const auto* now = parsed(read, at);
      CHECK((now != nullptr && now->items.size() == 2));
      draft.undo();
      CHECK(draft.text() == text);
      draft.redo();
      CHECK(draft.text() != text);
    });
  }
}

TEST_CASE("a key that is added can be read, and is gone without a trace when it is removed", "[document]") {
  const auto line = [](const std::string& a, const std::string& b) {
    CAPTURE(a, b);
    CHECK(a == b);
  };
  const std::string text =
      "a = 1 # one\n\n[t] # t\nk = 2\n# end of t\n\n[[b]]\nname = 'x'\ni = { p = 1 }\ne = {}\n"
      "g.one = 1 # g\nh = 3\n\n[s.one]\nv = 1\n";
  const Document document(text, "f.toml");
  line(document.with({"new"}, "5"), "a = 1 # one\nnew = 5" + text.substr(11));
  line(document.with({"t", "new"}, "5"),
       "a = 1 # one\n\n[t] # t\nk = 2\nnew = 5\n# end of t" + text.substr(37));
  CHECK(document.with({"b", "0", "i", "q"}, "5").find("i = { p = 1, q = 5 }\n") != std::string::npos);
  CHECK(document.with({"b", "0", "e", "q"}, "5").find("e = { q = 5 }\n") != std::string::npos);
  CHECK(document.with({"b", "0", "g", "two"}, "5").find("g.one = 1 # g\ng.two = 5\nh = 3\n") !=
        std::string::npos);
  CHECK(document.with({"b", "0", "r", "deep"}, "5").find("h = 3\nr.deep = 5\n\n[s") != std::string::npos);
  line(document.with({"s", "two", "v"}, "5"), text + "\n[s.two]\nv = 5\n");
  line(document.with({"u", "v"}, "5"), text + "\n[u]\nv = 5\n");
  for (const auto& [name, source] : all_texts()) {
    INFO(name);
    const Document all(source, "f.toml");
    Path path;
    std::set<std::string> tried;
    std::function<void(const Part&)> tables = [&](const Part& part) {
      if (part.is_table()) {
        auto at = path;
        at.push_back("zz new");
        INFO(Catch::Detail::stringify(at));
        const auto added = all.with(at, "7");
        const auto read = core::parse_toml(added, "");
        const auto* value = parsed(read, at);
        REQUIRE(value != nullptr);
        CHECK(value->integer == 7);
        // Adding and removing a key does not restore the text in two cases: an empty inline table gets other
        // spaces, and a new table has a header.
        if (part.kind != Part::Kind::dotted && !part.parts.empty())
          CHECK(Document(added, "").without(at) == source);
      }
      for (const auto& below : part.parts) {
        path.push_back(below.name);
        tables(below);
        path.pop_back();
      }
    };
    tables(all.root());
  }
}

TEST_CASE("tables, items and keys are removed with their lines, and the comments around them stay",
          "[document]") {
  const std::string text =
      "# top\n[[b]]\nname = 'x'\n[b.s]\nv = 1\n# end\n\n# two\n[[b]] # 2\nname = 'y'\n\n[z]\nl = [\n 1, # "
      "one\n 2,\n]\nw = 1\n";
  const Document document(text, "f.toml");
  CHECK(document.without({"b", "0"}) ==
        "# top\n# end\n\n# two\n[[b]] # 2\nname = 'y'\n\n[z]\nl = [\n 1, # one\n 2,\n]\nw = 1\n");
  CHECK(document.without({"b", "1"}) ==
        "# top\n[[b]]\nname = 'x'\n[b.s]\nv = 1\n# end\n\n# two\n\n[z]\nl = [\n 1, # one\n 2,\n]\nw = 1\n");
  CHECK(document.without({"z", "w"}) == text.substr(0, text.size() - 6));
  CHECK(document.without({"z", "l"}).ends_with("[z]\nw = 1\n"));
  CHECK(document.without({"z", "l", "0"}).ends_with("l = [\n 2,\n]\nw = 1\n"));
  CHECK(Document("l = [1, 2]", "").without({"l", "1"}) == "l = [1]");
  CHECK(Document("l = [1,]", "").without({"l", "0"}) == "l = []");
  CHECK(Document("l = {a = 1, b = 2}", "").without({"l", "a"}) == "l = {b = 2}");
  CHECK_THROWS_AS(document.without({"none"}), std::logic_error);
}

TEST_CASE("a copy of a table stands after it with the new name, with its comments and tables below",
          "[document]") {
  const Document blocks("[[b]]\nname = \"x\" # n\nv = 1 # one\n[b.s]\nw = 2\n\n[z]\n", "f.toml");
  CHECK(blocks.with_copy({"b", "0"}, "y") ==
        "[[b]]\nname = \"x\" # n\nv = 1 # one\n[b.s]\nw = 2\n\n[[b]]\nname = \"y\" # n\nv = 1 # "
        "one\n\n[b.s]\nw = 2\n\n[z]\n");
  const Document scenes("[scene.x]\nv = 1\n[scene.x.zone]\nw = 2", "f.toml");
  CHECK(scenes.with_copy({"scene", "x"}, "a b") ==
        "[scene.x]\nv = 1\n[scene.x.zone]\nw = 2\n\n[scene.\"a b\"]\nv = 1\n\n[scene.\"a b\".zone]\nw = 2");
}

TEST_CASE("every text that the parser of TOML accepts is read in the same way, also after random damage",
          "[document]") {
  std::mt19937 random(20261124);
  const std::string signs = "\"'[]{}=.,# \n\t\\a1-_+";
  int accepted = 0;
  for (int i = 0; i < 6000; ++i) {
    auto text = awkward;
    for (int damage = 0; damage < 1 + i % 3; ++damage) {
      const auto at = random() % text.size();
      if (i % 2 == 0)
        text.insert(at, 1, signs[random() % signs.size()]);
      else
        text.erase(at, 1 + random() % 3);
    }
    INFO(text);
    try {
      core::parse_toml(text, "f.toml");
    } catch (const core::BadInput&) {
      continue;
    }
    ++accepted;
    const auto truth = core::parse_toml(text, "f.toml");
    const Document document(text, "f.toml");
    std::size_t scalars = 0;
    Path path;
    each_value(document.root(), path, [&](const Path& at, const Part& part) {
      scalars += part.kind == Part::Kind::scalar;
      const auto* expected = parsed(truth, at);
      REQUIRE(expected != nullptr);
      REQUIRE(same(core::value_of(part), *expected));
    });
    REQUIRE(scalars == leaves(truth));
  }
  CHECK(accepted > 500);
}

TEST_CASE("a value cannot smuggle in a second key, and a broken text is kept as it is", "[document]") {
  const Document document("a = 1\n", "f.toml");
  CHECK_THROWS(document.with({"a"}, "1\nb = 2"));
  CHECK_THROWS_AS(document.with({"a"}, "[1"), core::BadInput);
  view::Draft draft("a = 1\n", "f.toml");
  draft.change("a = [\n");
  CHECK(draft.document() == nullptr);
  REQUIRE(draft.problems().size() == 1);
  CHECK(draft.problems()[0].place.file == "f.toml");
  CHECK(draft.text() == "a = [\n");
  draft.undo();
  CHECK(draft.document() != nullptr);
}

TEST_CASE("texts and names are written so that TOML reads them back", "[document]") {
  for (const std::string text : {"plain", "with \"quotes\" and \\", "a\nb\tc", "\x01\x7F", "日本 ü", ""}) {
    CHECK(core::parse_toml("k = " + view::toml_string(text), "").entries[0].value.string == text);
    CHECK(core::parse_toml(view::key_of(text) + " = 1", "").entries[0].key == text);
  }
}

TEST_CASE("the innermost key at a place is found", "[document]") {
  const Document document(
      "# c\n[t]\nk = 1\n\n[[b]]\nname = 'x'\nl = [\n  1,\n  { a = 2 },\n]\n[b.s]\nv = 1\n", "f.toml");
  CHECK(document.at(1) == Path{});
  CHECK(document.at(2) == Path{"t"});
  CHECK(document.at(3) == Path{"t", "k"});
  CHECK(document.at(6) == Path{"b", "0", "name"});
  CHECK(document.at(7) == Path{"b", "0", "l"});
  CHECK(document.at(9) == Path{"b", "0", "l", "1"});
  CHECK(document.at(9, 5) == Path{"b", "0", "l", "1", "a"});
  CHECK(Document("k = { \"ü\" = 1, b = 2 }", "").at(1, 17) == Path{"k", "b"});
  CHECK(document.at(12) == Path{"b", "0", "s", "v"});
}

TEST_CASE("two tables change places with their comments and the tables below them, and nothing else changes",
          "[document]") {
  const std::string text =
      "# head\n\n# about x\n[[b]]\nname = \"x\"\n[b.s]\nw = 2\n\n[z]\n\n[[e]]\nname = \"y\" # "
      "why\n\n[[b]]\nname = \"c\"\n";
  const Document document(text, "f.toml");
  const auto moved = document.exchanged({"b", "0"}, {"e", "0"});
  CHECK(moved ==
        "# head\n\n[[e]]\nname = \"y\" # why\n\n[z]\n\n# about x\n[[b]]\nname = \"x\"\n[b.s]\nw = "
        "2\n\n[[b]]\nname = \"c\"\n");
  CHECK(Document(moved, "f.toml").exchanged({"b", "0"}, {"e", "0"}) == text);
  CHECK(document.exchanged({"e", "0"}, {"b", "0"}) == moved);
  CHECK_THROWS_AS(document.exchanged({"b", "0"}, {"b", "7"}), std::logic_error);
  CHECK_THROWS_AS(document.exchanged({"b", "0"}, {"b", "0", "s"}), std::logic_error);
  CHECK(document.with_tables("[[n]]\nv = 1\n") == text + "\n[[n]]\nv = 1\n");
  CHECK(Document("a = 1", "").with_tables("[n]\n") == "a = 1\n\n[n]\n");
}

TEST_CASE("each comment stays with its item, and with its table", "[document]") {
  const Document list("l = [\n  # the list\n  1, # one\n  2,\n  3 # three\n]\nv = 1\n", "f.toml");
  CHECK(list.exchanged({"l", "1"}, {"l", "2"}) ==
        "l = [\n  # the list\n  1, # one\n  3, # three\n  2\n]\nv = 1\n");
  CHECK(list.without({"l", "2"}) == "l = [\n  # the list\n  1, # one\n  2,\n]\nv = 1\n");
  CHECK(list.without({"l", "0"}) == "l = [\n  # the list\n  2,\n  3 # three\n]\nv = 1\n");
  CHECK(list.with({"l", "3"}, "4") == "l = [\n  # the list\n  1, # one\n  2,\n  3, # three\n  4\n]\nv = 1\n");
  const Document above("l = [\n  # one\n  1,\n  # two\n  2,\n]\n", "f.toml");
  CHECK(above.exchanged({"l", "1"}, {"l", "0"}) == "l = [\n  # two\n  2,\n  # one\n  1,\n]\n");
  const Document within("l = [1, 2, 3] # all\n", "f.toml");
  CHECK(within.exchanged({"l", "1"}, {"l", "2"}) == "l = [1, 3, 2] # all\n");
  CHECK(within.without({"l", "2"}) == "l = [1, 2] # all\n");
  const Document windows("l = [\r\n  1, # one\r\n  2 # two\r\n]\r\n", "f.toml");
  CHECK(windows.exchanged({"l", "0"}, {"l", "1"}) == "l = [\r\n  2, # two\r\n  1 # one\r\n]\r\n");
  CHECK(windows.without({"l", "1"}) == "l = [\r\n  1, # one\r\n]\r\n");

  const Document tables("[[b]]\nv = 1\n# u = 2, switched off\n\n  # about two\n[[b]]\nv = 2\n", "f.toml");
  CHECK(tables.exchanged({"b", "0"}, {"b", "1"}) ==
        "  # about two\n[[b]]\nv = 2\n\n[[b]]\nv = 1\n# u = 2, switched off\n");
}

TEST_CASE("a key beside tables with headers below an item of a list is added to this item", "[document]") {
  const std::string first = "[[p]]\nname = \"a\"\n[p.grid.x]\nv = [1]\n[p.grid.y]\nv = [2]\n";
  const std::string second = "\n[[p]]\nname = \"b\"\n[p.grid.x]\nv = [3]\n";
  const Document document(first + second, "f.toml");
  const auto added = document.with({"p", "0", "grid", "z"}, "{}");
  CHECK(added == first + "\n[p.grid]\nz = {}\n" + second);
  const Document twice(added, "f.toml");
  CHECK(twice.find({"p", "0", "grid", "z"}) != nullptr);
  CHECK(twice.find({"p", "1", "0"}) == nullptr);
  CHECK(Document(twice.with({"p", "0", "grid", "u"}, "1"), "").written({"p", "0", "grid", "u"}) == "1");
  CHECK(Document(document.with({"p", "1", "grid", "z"}, "1"), "").written({"p", "1", "grid", "z"}) == "1");
  // a new item of a list has no header that could be written
  CHECK_THROWS_AS(document.with({"p", "2", "name"}, "1"), std::logic_error);
}
