// Tests that every shipped protocol can be made in the designer from an empty study, without typing any TOML.
// A person who copies a protocol looks at its form and does the same in an empty one; so does this test. It
// uses only what a tap can do: add a table, choose or type a value, add and remove an item of a list, move
// it.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include "station/core/canonical.hpp"
#include "station/core/read_file.hpp"
#include "station/protocol/protocol.hpp"
#include "station/view/form.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using view::Document;
using view::Field;
using view::Path;
using Input = Field::Input;

namespace {

struct Taps {
  int taps = 0;  ///< besides those on keys of the keyboard
  int keys = 0;
};

/// The characters on the keyboard of the screen: all that stand in quotes in its rows.
std::set<std::string> keys_of_the_screen() {
  const auto file =
      core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/station/ui/shared/ScreenKeyboard.qml");
  const auto begin = file.find("readonly property var layouts"),
             end = file.find("readonly property real gap");
  REQUIRE(begin < end);
  REQUIRE(end < file.size());
  std::set<std::string> keys;
  bool quoted = false;
  for (auto at = begin; at < end;) {
    const bool escaped = quoted && file[at] == '\\';
    if (escaped) ++at;
    auto next = at + 1;
    while ((static_cast<unsigned char>(file[next]) & 0xC0) == 0x80) ++next;
    if (file[at] == '"' && !escaped)
      quoted = !quoted;
    else if (quoted)
      keys.insert(file.substr(at, next - at));
    at = next;
  }
  return keys;
}

/// Whether a character can be typed on the screen, with capitals. Chinese characters and kana need an input
/// method, as everywhere; a line break has a key where texts are typed.
bool on_the_screen(std::string character, const Field& field) {
  static const auto keys = keys_of_the_screen();
  if (field.input == Input::number)
    return std::string("0123456789.-,e+ ").find(character) != std::string::npos;
  if (character == "\n") return field.input == Input::text;
  if (character == " " || static_cast<unsigned char>(character[0]) >= 0xE3) return true;
  if (character[0] >= 'A' && character[0] <= 'Z') character[0] = static_cast<char>(character[0] + 32);
  const auto second = character.size() > 1 ? static_cast<unsigned char>(character[1]) : 0;
  if (static_cast<unsigned char>(character[0]) == 0xC3 && second < 0x9F)
    character[1] = static_cast<char>(second + 0x20);
  return keys.count(character) > 0;
}

/// The designer, as a person uses it: it knows which page is shown, and counts what is tapped.
class Hand {
 public:
  explicit Hand(std::string text) : text_(std::move(text)) {}

  Document document() const { return {text_, "made.toml"}; }
  const Taps& taps() const { return taps_; }

  void add(const std::string& section, const std::string& kind) {
    turn_to(section);
    ++taps_.taps;
    text_ = document().with_tables(view::new_table(document(), kind));
  }
  void set(const std::string& section, const view::Group& group, const Field& field,
           const std::string& value) {
    reach(section, group, field);
    const auto chips =
        field.input == Input::boolean || (field.input == Input::word && field.allowed.size() <= 4);
    if (chips) {
      taps_.taps += 1;
    } else if (field.input == Input::word) {
      taps_.taps += 2;  // opens the choices and takes one
    } else if (field.input == Input::names && !field.allowed.empty()) {
      taps_.taps += 3 + static_cast<int>(std::count(value.begin(), value.end(), ','));
    } else {
      taps_.taps += 2;  // opens the keyboard and closes it
      taps_.keys += static_cast<int>(value.size() + field.value.size());
      for (std::size_t at = 0, next = 0; at < value.size(); at = next) {
        for (next = at + 1; next < value.size() && (static_cast<unsigned char>(value[next]) & 0xC0) == 0x80;)
          ++next;
        INFO(value);
        CHECK(on_the_screen(value.substr(at, next - at), field));
      }
    }
    text_ = view::changed(document(), field, value);
  }
  void extend(const std::string& section, const view::Group& group, const Field& field) {
    reach(section, group, field);
    ++taps_.taps;
    text_ = view::extended(document(), field);
  }
  void reduce(const std::string& section, const view::Group& group, const Field& field) {
    reach(section, group, field);
    ++taps_.taps;
    text_ = view::reduced(document(), field);
  }

 private:
  void turn_to(const std::string& section) {
    taps_.taps += section != section_;
    section_ = section;
  }
  void reach(const std::string& section, const view::Group& group, const Field& field) {
    turn_to(section);
    const bool hidden = !field.present && !field.required;
    if (hidden && opened_.insert(group.path).second) ++taps_.taps;  // more settings
  }

  std::string text_, section_;
  std::set<Path> opened_;
  Taps taps_;
};

using Form = std::vector<view::Section>;

const Field* find(const Form& form, const Path& path, bool value) {
  for (const auto& section : form)
    for (const auto& group : section.groups)
      for (const auto& field : group.fields) {
        const bool table = field.input == Input::table || field.input == Input::list;
        if (field.path == path && table != value && field.input != Input::entry &&
            field.input != Input::list_name)
          return &field;
      }
  return nullptr;
}

/// One thing that differs, done; false if nothing differs or nothing can be done.
bool one_step(Hand& hand, const Form& wanted) {
  const auto document = hand.document();
  const auto form = view::form_of(document, {});
  const auto step = [&](const view::Section& section, const view::Group& group, const Field& field) {
    const auto& name = section.name;
    switch (field.input) {
      case Input::entry:  // what the user names
        for (const auto& other : wanted)
          for (const auto& there : other.groups)
            for (const auto& one : there.fields)
              if (one.path.size() == field.path.size() + 1 &&
                  std::equal(field.path.begin(), field.path.end(), one.path.begin()) &&
                  document.find(one.path) == nullptr)
                return hand.set(name, group, field, one.path.back() + " = " + one.value), true;
        return false;
      case Input::list_name:
        for (const auto& other : wanted)
          for (const auto& there : other.groups)
            for (const auto& one : there.fields)
              if (one.input == Input::list && one.path.size() == field.path.size() + 1 &&
                  std::equal(field.path.begin(), field.path.end(), one.path.begin()) &&
                  document.find(one.path) == nullptr)
                return hand.set(name, group, field, one.path.back()), true;
        return false;
      case Input::name:
        return false;
      case Input::table: {
        const auto* there = find(wanted, field.path, false);
        const bool should = there != nullptr && there->present;
        if (field.present && !should && field.removable) return hand.reduce(name, group, field), true;
        if (!field.present && should) return hand.extend(name, group, field), true;
        return false;
      }
      case Input::list: {
        const auto* there = find(wanted, field.path, false);
        const int more = (there == nullptr ? 0 : std::stoi(there->value)) - std::stoi(field.value);
        if (more > 0) return hand.extend(name, group, field), true;
        return false;
      }
      default: {
        const auto* there = find(wanted, field.path, true);
        const auto value = there == nullptr || !there->present ? "" : there->value;
        if (value == (field.present ? field.value : "")) return false;
        if (value.empty() && field.required) return false;
        return hand.set(name, group, field, value), true;
      }
    }
  };
  for (const auto& section : form)
    for (const auto& group : section.groups)
      for (const auto& field : group.fields)
        if (step(section, group, field)) return true;
  return false;
}

/// Adds the tables that a file can have several of, in the order of the file, and gives them their names.
void add_tables(Hand& hand, const Form& wanted) {
  for (const auto& section : wanted)
    for (const auto& group : section.groups) {
      if (group.name.empty()) continue;
      hand.add(section.name, group.path.front());
      const auto document = hand.document();
      const auto form = view::form_of(document, {});
      const auto& groups = std::find_if(form.begin(), form.end(), [&](const auto& one) {
                             return one.name == section.name;
                           })->groups;
      // the new one is the last of its kind
      const view::Group* added = nullptr;
      for (const auto& one : groups)
        if (one.path.front() == group.path.front()) added = &one;
      REQUIRE(added != nullptr);
      for (const auto& field : added->fields)
        if (field.input == Input::name || (field.path.size() == 3 && field.path.back() == "name")) {
          hand.set(section.name, *added, field, group.name);
          break;
        }
    }
}

std::vector<std::string> order_of(const Form& form) {
  std::vector<std::string> parts;
  for (const auto& section : form)
    if (section.name == "blocks")
      for (const auto& group : section.groups) parts.push_back(group.path.front() + " " + group.name);
  return parts;
}

}  // namespace

TEST_CASE("every shipped protocol can be made from an empty study by taps", "[form]") {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TURNPOINT_SOURCE_DIR) + "/protocols"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() > 20);
  // one with an interval of several parts
  files.push_back(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/gallery/adaptation.toml");
  for (const auto& file : files) {
    INFO(file);
    const Document target(core::read_file(file), file);
    const auto wanted = view::form_of(target, {});
    Hand hand(view::empty_study("study"));
    // the languages first, because new texts are in all of them
    for (int i = 0; i < 5 && hand.document().written({"protocol", "languages"}) !=
                                 target.written({"protocol", "languages"});
         ++i)
      if (!one_step(hand, {wanted.front()})) break;
    add_tables(hand, wanted);
    int steps = 0;
    while (steps < 1000 && one_step(hand, wanted)) ++steps;
    CHECK(steps < 1000);
    CHECK(core::canonical(core::parse_toml(hand.document().text(), "")) ==
          core::canonical(core::parse_toml(target.text(), "")));
    CHECK(order_of(view::form_of(hand.document(), {})) == order_of(wanted));
    CHECK_NOTHROW(protocol::parse(hand.document().text(), file));
    std::printf("%s: %d taps, %d on keys of the keyboard\n", std::filesystem::path(file).stem().c_str(),
                hand.taps().taps, hand.taps().keys);
    // Only what a program gets as it is, is typed as it is written in the file.
    for (const auto& section : wanted)
      for (const auto& group : section.groups)
        for (const auto& field : group.fields)
          if (field.present && field.input == Input::written) CHECK(field.path[2] == "settings");
  }
}
