// Tests that the form of a protocol has every key of the file, and shows each value as a person would write
// it.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "station/core/canonical.hpp"
#include "station/core/read_file.hpp"
#include "station/core/texts.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/protocol_keys.hpp"
#include "station/view/form.hpp"
#include "station/view/goals.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using view::Document;
using view::Field;
using view::Part;
using view::Path;

namespace {

const std::string root = TURNPOINT_SOURCE_DIR;

std::vector<std::string> shipped() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(root + "/protocols"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  return files;
}

const Field* find(const std::vector<view::Section>& form, const Path& path) {
  for (const auto& section : form)
    for (const auto& group : section.groups)
      for (const auto& field : group.fields)
        if (field.path == path) return &field;
  return nullptr;
}

void each_scalar(const Part& part, Path& path, std::vector<Path>& all) {
  if (part.kind == Part::Kind::scalar) all.push_back(path);
  for (const auto& below : part.parts) {
    path.push_back(below.name);
    each_scalar(below, path, all);
    path.pop_back();
  }
}

bool leads_to(const Path& start, const Path& path) {
  return start.size() <= path.size() && std::equal(start.begin(), start.end(), path.begin());
}

std::string question(const std::string& text) { return "v = " + text; }

std::string said(const std::string& source) { return core::canonical(core::parse_toml(source, "")); }

/// Whether a field is a value, and not a table with fields of its own.
bool is_value(const Field& field) {
  using Input = Field::Input;
  return field.input != Input::table && field.input != Input::list && field.input != Input::entry &&
         field.input != Input::list_name && field.input != Input::name;
}

}  // namespace

TEST_CASE("every value of every shipped protocol has exactly one field, which leaves the file as it is",
          "[form]") {
  REQUIRE(shipped().size() > 20);
  for (const auto& file : shipped()) {
    INFO(file);
    const Document document(core::read_file(file), file);
    const auto form = form_of(document, {});
    std::vector<Path> scalars;
    Path path;
    each_scalar(document.root(), path, scalars);
    for (const auto& scalar : scalars) {
      if (scalar == Path{"format"}) continue;
      INFO(Catch::Detail::stringify(scalar));
      int fields = 0;
      for (const auto& section : form)
        for (const auto& group : section.groups)
          for (const auto& field : group.fields)
            fields += is_value(field) && field.present && leads_to(field.path, scalar);
      CHECK(fields == 1);
    }
    for (const auto& section : form)
      for (const auto& group : section.groups)
        for (const auto& field : group.fields) {
          if (!is_value(field)) continue;
          INFO(Catch::Detail::stringify(field.path));
          CHECK(view::changed(document, field, field.value) == document.text());
          // To the parser, the value that the form writes equals the value in the file.
          if (!field.present) continue;
          const auto written = view::encoded(field, field.value);
          const auto a = core::parse_toml(question(written), "").entries[0].value;
          const auto b = core::value_of(*document.find(field.path));
          CHECK(a.kind == b.kind);
          CHECK(a.string == b.string);
          CHECK(a.number == b.number);
          CHECK(a.items.size() == b.items.size());
        }
  }
}

TEST_CASE("a file with several tasks has a group for each of them, and none for a single one", "[form]") {
  const Document document(
      "[tasks.side]\nkind = \"single-interval\"\nintervals = [\"edge\"]\n[tasks.which]\nkind = \"2ifc\"\n"
      "[[procedure]]\nname = \"steps\"\ntask = \"which\"\n",
      "tasks.toml");
  const auto form = view::form_of(document, {});
  std::vector<Path> tasks;
  for (const auto& section : form)
    for (const auto& group : section.groups) {
      CHECK(group.path != Path{"task"});
      if (group.path.front() != "tasks") continue;
      CHECK(section.name == "question");
      CHECK_FALSE(group.removable);  // a file has one [task] or two or more
      tasks.push_back(group.path);
    }
  CHECK(tasks == std::vector<Path>{{"tasks", "side"}, {"tasks", "which"}});
  const auto* field = find(form, {"tasks", "which", "gap_s"});
  REQUIRE(field != nullptr);
  const auto* named = find(form, {"procedure", "0", "task"});
  if (named == nullptr) named = find(form, {"procedure", "steps", "task"});
  REQUIRE(named != nullptr);
  CHECK(named->allowed == std::vector<std::string>{"side", "which"});
}

TEST_CASE("fields have the kind, words and limits of the table of keys, and the names that the file gives",
          "[form]") {
  const auto file = root + "/protocols/friction-2ifc.toml";
  const Document document(core::read_file(file), file);
  const auto form = form_of(document, {});
  const auto* kind = find(form, {"task", "kind"});
  REQUIRE(kind != nullptr);
  CHECK(kind->value == "2ifc");
  CHECK(std::count(kind->allowed.begin(), kind->allowed.end(), "oddity") == 1);
  const auto* intervals = find(form, {"task", "intervals"});
  CHECK(intervals->value == "reference, comparison");
  CHECK(intervals->allowed == std::vector<std::string>{"reference", "comparison", "reference → comparison",
                                                       "comparison → reference"});
  CHECK(find(form, {"task", "question", "de"})->value == "In welchem Durchgang war es glatter?");
  CHECK(find(form, {"task", "choices", "1", "label", "en"})->value == "Second");
  CHECK(find(form, {"scene", "reference", "zone", "from_mm"})->value == "60.0");
  CHECK(find(form, {"scene", "comparison", "friction_contrast_dB"})->input == Field::Input::expression);
  CHECK(find(form, {"timing", "iti_s", "uniform"})->value == "0.8, 1.2");
  CHECK(find(form, {"procedure", "0", "stop", "trials"})->value == "96");
  CHECK(find(form, {"block", "0", "levels"})->value == "-3.0, -5.0");
  CHECK(find(form, {"block", "1", "catch", "contrast_dB"})->value == "-3.0");
  const auto* absent = find(form, {"block", "0", "pass", "accuracy"});
  REQUIRE(absent != nullptr);
  CHECK_FALSE(absent->present);
  CHECK(absent->forms.front()->range.high == 1.0);
  CHECK(find(form, {"scene", "reference", "base"})->key->help.starts_with("scene from which"));
}

namespace {

/// Calls `see` with each key that a protocol can have, in every table and every form. Names that the user
/// chooses have none.
void each_key(const core::Keys& keys, const std::function<void(const core::Key&)>& see);
void each_form(const core::Key& key, const std::function<void(const core::Key&)>& see) {
  if (key.keys) each_key(*key.keys, see);
  for (const auto& form : key.forms) each_form(form, see);
}
void each_key(const core::Keys& keys, const std::function<void(const core::Key&)>& see) {
  for (const auto& key : keys.list) see(key), each_form(key, see);
  if (keys.named) each_form(*keys.named, see);
}

void each_word(const core::Key& key, std::set<std::string>& words) {
  words.insert(key.words.begin(), key.words.end());
  for (const auto& form : key.forms) each_word(form, words);
}

}  // namespace

TEST_CASE("every key of a protocol, and everything that can be chosen for it, has a word and a line of help",
          "[form]") {
  const auto& texts = core::catalogue("en");
  int keys = 0, words = 0;
  each_key(protocol::protocol_keys(), [&](const core::Key& key) {
    INFO(key.name);
    CHECK_FALSE(key.help.empty());
    if (key.name == "format") return;  // the same in every file, so no page shows it
    ++keys;
    CHECK(texts.count("design.keys." + key.name) == 1);
    std::set<std::string> chosen;
    each_word(key, chosen);
    for (const auto& word : chosen) {
      INFO(word);
      ++words;
      CHECK(texts.count("design.words." + key.name + "." + word) == 1);
    }
  });
  CHECK(keys > 200);
  CHECK(words > 80);
}

TEST_CASE("what is typed into a field is what the reader of protocols reads", "[form]") {
  const auto file = root + "/protocols/friction-2ifc.toml";
  const auto type = [&](const std::string& source, const Path& path, const std::string& typed) {
    const Document document(source, file);
    const auto form = form_of(document, {});
    const auto* field = find(form, path);
    REQUIRE(field != nullptr);
    return view::changed(document, *field, typed);
  };
  auto source = core::read_file(file);
  source = type(source, {"block", "0", "levels"}, "-3, -4.5,-6");
  source = type(source, {"block", "0", "trials"}, "9");
  source = type(source, {"block", "0", "pass", "accuracy"}, "0.8");
  source = type(source, {"block", "0", "pass", "retries"}, "2");
  source = type(source, {"task", "question", "en"}, "Which was \"slicker\"?\nTell us.");
  source = type(source, {"scene", "reference", "zone", "from_mm"}, "70");
  source = type(source, {"scene", "comparison", "friction_contrast_dB"}, "contrast_dB - 1");
  source = type(source, {"random", "seed"}, "per-session");
  const auto read = protocol::parse(source, file);
  const auto& practice = std::get<protocol::Block>(read.plan.at(0));
  CHECK(practice.levels == std::vector<double>{-3, -4.5, -6});
  CHECK(practice.trials == 9);
  REQUIRE(practice.pass.has_value());
  CHECK(practice.pass->accuracy == 0.8);
  CHECK(practice.pass->retries == 2);
  CHECK(read.task.question.at("en") == "Which was \"slicker\"?\nTell us.");
  CHECK(read.scenes.at("reference").zone->from_mm == 70);
  CHECK_THROWS_AS(type(source, {"block", "0", "trials"}, "2.5"), core::BadInput);
  CHECK_THROWS_AS(type(source, {"block", "0", "levels"}, "1, two"), core::BadInput);
  CHECK_THROWS_AS(type(source, {"scene", "reference", "zone", "from_mm"}, "1\nx = 2"), core::BadInput);
  // An empty text removes an optional key. A required key stays, until its table is removed.
  source = type(type(source, {"block", "0", "pass", "retries"}, ""), {"block", "0", "pass", "accuracy"}, "");
  CHECK(source.find("pass.accuracy") != std::string::npos);
  const Document with_pass(source, file);
  const auto form = form_of(with_pass, {});
  source = view::reduced(with_pass, *find(form, {"block", "0", "pass"}));
  CHECK(source.find("pass") == std::string::npos);
  CHECK(type(source, {"task", "kind"}, "") == source);
}

TEST_CASE("an interval of several parts is begun by its name, and its parts are added one by one", "[form]") {
  const std::string scenes = "format = \"friction-protocol/1\"\n[scene.adaptor]\n[scene.edge]\n";
  const auto begin = [](const Document& document) {
    for (const auto& section : form_of(document, {}))
      for (const auto& group : section.groups)
        for (const auto& field : group.fields)
          if (field.input == Field::Input::list_name && field.path == Path{"task", "parts"}) return field;
    FAIL("no field for a new interval");
    return Field{};
  };
  const Document document(scenes + "[task]\nkind = \"2ifc\"\n", "p.toml");
  const Document one(view::changed(document, begin(document), "adapted"), "p.toml");
  CHECK(said(one.text()) == said(scenes + "[task]\nkind = \"2ifc\"\n[task.parts]\n"
                                          "adapted = [{ scene = \"adaptor\" }]\n"));
  const Document two(view::changed(one, begin(one), "other"), "p.toml");
  CHECK(two.find({"task", "parts", "other"}) != nullptr);
  CHECK(two.find({"task", "parts", "adapted"}) != nullptr);
  // its parts can be added, and intervals can name it
  bool extends = false, named = false;
  for (const auto& section : form_of(two, {}))
    for (const auto& group : section.groups)
      for (const auto& field : group.fields) {
        if (field.path == Path{"task", "parts", "adapted"} && field.input == Field::Input::list) {
          extends = true;
          const Document more(view::extended(two, field), "p.toml");
          CHECK(more.find({"task", "parts", "adapted", "1", "scene"}) != nullptr);
        }
        if (field.path == Path{"task", "intervals"})
          named = std::count(field.allowed.begin(), field.allowed.end(), "adapted") == 1;
      }
  CHECK(extends);
  CHECK(named);
  for (const char* bad : {"two words", "a.b", "\"", "\u00e4"}) {
    INFO(bad);
    CHECK_THROWS_AS(view::changed(document, begin(document), bad), core::BadInput);
  }
  CHECK_THROWS_AS(view::changed(one, begin(one), "adapted"), core::BadInput);
  CHECK(view::changed(one, begin(one), "") == one.text());
}

TEST_CASE("another name of a table is also given to what refers to it", "[form]") {
  int renamed = 0;
  for (const auto& file : shipped()) {
    const Document document(core::read_file(file), file);
    for (const auto& section : form_of(document, {}))
      for (const auto& group : section.groups)
        for (const auto& field : group.fields) {
          const bool name =
              field.input == Field::Input::name || (field.path.size() == 3 && field.path.back() == "name");
          if (!name || !field.present || field.path.front() == "factor") continue;
          INFO(file << ": " << field.path.front() << " " << field.value);
          ++renamed;
          const auto other = view::changed(document, field, "another-name");
          std::vector<std::string> problems;
          try {
            protocol::parse(other, file);
          } catch (const core::BadInput& bad) {
            for (const auto& problem : bad.problems()) problems.push_back(core::format(problem));
          }
          CHECK(problems == std::vector<std::string>{});
          // and back
          const Document now(other, file);
          auto path = field.path;
          if (field.input == Field::Input::name) path.back() = "another-name";
          const auto form = form_of(now, {});
          const auto* again = find(form, path);
          REQUIRE(again != nullptr);
          CHECK(said(view::changed(now, *again, field.value)) == said(document.text()));
        }
  }
  CHECK(renamed > 100);
}

TEST_CASE("a decimal comma is refused where it would become two numbers", "[form]") {
  const auto file = root + "/protocols/friction-2ifc.toml";
  const Document document(core::read_file(file), file);
  const auto form = form_of(document, {});
  const auto* levels = find(form, {"block", "0", "levels"});
  REQUIRE(levels != nullptr);
  for (const char* typed : {"1,5", "0,5, 1", "-1,5 2"}) {
    try {
      view::changed(document, *levels, typed);
      FAIL(typed);
    } catch (const core::BadInput& bad) {
      CHECK(core::say(bad.problems().front().allowed, "en").find("decimal point") != std::string::npos);
    }
  }
  CHECK(view::encoded(*levels, "1, 5") == "[1, 5]");
  CHECK(view::encoded(*levels, "1 5") == "[1, 5]");
  CHECK(view::encoded(*levels, "1,-5") == "[1, -5]");
}

TEST_CASE("a text that looks like a number stays a text", "[form]") {
  const std::string source =
      "[[factor]]\nname = \"condition\"\nlevels = [\"1\", \"2\"]\n[[factor]]\nname = \"x_mm\"\nlevels = [1]\n"
      "[[factor]]\nname = \"new\"\n[[factor]]\nname = \"wide\"\nlevels = [\"low, wide\", \"high\"]\n"
      "[[procedure]]\nname = \"a\"\n[[questionnaire]]\nname = \"q\"\n[[questionnaire.item]]\nid = \"i\"\n"
      "choices = [{ id = \"1\" }, { id = \"2\" }]\n[[questionnaire.item]]\nid = \"n\"\nnumber = {}\n";
  const Document document(source, "f.toml");
  const auto form = form_of(document, {});
  const auto typed = [&](const Path& path, const std::string& text) {
    const auto* field = find(form, path);
    REQUIRE(field != nullptr);
    return Document(view::changed(document, *field, text), "f.toml").written(path);
  };
  CHECK(typed({"factor", "0", "levels"}, "1, 2, 3") == "[\"1\", \"2\", \"3\"]");
  CHECK(typed({"factor", "1", "levels"}, "1, 2") == "[1, 2]");
  CHECK(typed({"factor", "2", "levels"}, "1, 2") == "[1, 2]");
  CHECK(typed({"procedure", "0", "with", "condition"}, "1") == "\"1\"");
  CHECK(typed({"procedure", "0", "with", "x_mm"}, "1") == "1");
  CHECK(typed({"questionnaire", "0", "item", "0", "simulated"}, "2") == "\"2\"");
  CHECK(typed({"questionnaire", "0", "item", "1", "simulated"}, "2") == "2");
  // a list with a text that has a comma is shown and typed as it is written
  CHECK(find(form, {"factor", "3", "levels"})->value == "[\"low, wide\", \"high\"]");
}

TEST_CASE("a key of a copy, or of a scene with a base, has no default of its own", "[form]") {
  const Document document(
      "[scene.a]\n[scene.b]\nbase = \"a\"\n[[procedure]]\nname = \"p\"\nkind = \"staircase\"\n[[procedure]]\n"
      "name = \"q\"\ncopy = \"p\"\n",
      "f.toml");
  const auto form = form_of(document, {});
  CHECK_FALSE(find(form, {"scene", "a", "ramp_ms"})->inherited);
  CHECK(find(form, {"scene", "b", "ramp_ms"})->inherited);
  CHECK_FALSE(find(form, {"procedure", "0", "discard_reversals"})->inherited);
  CHECK(find(form, {"procedure", "1", "discard_reversals"})->inherited);
}

TEST_CASE("every problem of a check stands at its field", "[form]") {
  const auto file = root + "/protocols/friction-2ifc.toml";
  auto source = core::read_file(file);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto at = source.find(from);
    REQUIRE(at != std::string::npos);
    source.replace(at, from.size(), to);
  };
  replace("device = \"touch\"", "device = \"tuch\"");
  replace("de = \"Im ersten\"", "fr = \"Le premier\"");
  replace("gap_s = 1.0\n", "gap_s = -1.0\n");
  replace("deadline_s = 3.0\n", "");
  replace("procedures = [\"threshold\"]", "procedures = [\"treshold\"]");
  std::vector<core::Problem> problems;
  try {
    protocol::parse(source, file);
  } catch (const core::BadInput& bad) {
    problems = bad.problems();
  }
  REQUIRE(problems.size() >= 5);
  const auto form = form_of(Document(source, file), problems);
  for (const Path& path : {Path{"task", "device"}, Path{"task", "gap_s"}, Path{"timing", "deadline_s"},
                           Path{"block", "1", "procedures"}}) {
    INFO(Catch::Detail::stringify(path));
    const auto* field = find(form, path);
    REQUIRE(field != nullptr);
    REQUIRE(field->remarks.size() == 1);
  }
  std::set<std::size_t> placed;
  for (const auto& section : form)
    for (const auto& group : section.groups) {
      placed.insert(group.remarks.begin(), group.remarks.end());
      for (const auto& field : group.fields) placed.insert(field.remarks.begin(), field.remarks.end());
    }
  CHECK(placed.size() == problems.size());
}

TEST_CASE("every goal leads to a shipped protocol, which becomes a study of its own", "[goals]") {
  std::set<std::string> words;
  for (const auto& goal : view::goals()) {
    INFO(goal.word);
    CHECK(words.insert(goal.word).second);
    CHECK(view::describe(goal, "de") != view::describe(goal, "en"));
    const auto source = core::read_file(root + "/protocols/" + goal.file + ".toml");
    const auto study = protocol::parse(view::study_from(goal, source, "my-study"), "my-study.toml");
    CHECK(study.id == "my-study");
    CHECK(study.version == "0.1.0");
    CHECK(study.title == protocol::parse(source, "").title);
  }
  CHECK(view::find_goal("contrast") != nullptr);
  CHECK(view::find_goal("nothing") == nullptr);
}

TEST_CASE("each kind of interlude can be added to each shipped protocol, filled, moved and removed",
          "[form]") {
  for (const auto& file : shipped()) {
    const Document document(core::read_file(file), file);
    const auto parts_of = [](const Document& of) {
      for (auto& section : form_of(of, {}))
        if (section.name == "blocks") return section.groups;
      return std::vector<view::Group>();
    };
    const auto before = parts_of(document);
    for (const std::string kind : {"consent", "explanation", "questionnaire", "screening"}) {
      INFO(file << ", " << kind);
      Document added(document.with_tables(view::new_table(document, kind)), file);
      auto parts = parts_of(added);
      REQUIRE(parts.size() == before.size() + 1);
      // it is the last part of the session, and the protocol can be read
      CHECK(parts.back().path.front() == kind);
      CHECK(parts.back().later.empty());
      const auto name = parts.back().name;
      CHECK(parts.back().removable);
      if (kind != "screening") CHECK_NOTHROW(protocol::parse(added.text(), file));
      for (const auto& list : parts.back().fields) {
        if (list.input != Field::Input::list || list.path.size() != 3 || list.value == "0") continue;
        const Document longer(view::extended(added, list), file);
        CHECK_NOTHROW(protocol::parse(longer.text(), file));
        auto last = list.path;
        last.push_back("1");
        const auto form = form_of(longer, {});
        const auto* second = find(form, last);
        REQUIRE(second != nullptr);
        CHECK(longer.find({last[0], last[1], last[2], "2"}) == nullptr);
        const Document moved(view::moved_up(longer, *second), file);
        CHECK(moved.find(last) != nullptr);
        CHECK(said(view::reduced(longer, *second)) == said(added.text()));
      }
      // to the beginning of the session, and out of it
      for (bool moves = true; moves;) {
        const auto own = std::find_if(parts.begin(), parts.end(), [&](const view::Group& part) {
          return part.path.front() == kind && part.name == name;
        });
        REQUIRE(own != parts.end());
        moves = !own->earlier.empty();
        if (!moves) break;
        added = Document(added.exchanged(own->path, own->earlier), file);
        parts = parts_of(added);
      }
      CHECK(parts.front().path.front() == kind);
      CHECK(parts.front().earlier.empty());
      CHECK(parts_of(Document(added.without(parts.front().path), file)).size() == before.size());
    }
  }
}
