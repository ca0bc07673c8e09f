#include "station/protocol/glyphs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "station/core/letters.hpp"
#include "station/core/toml.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

// True for characters that need not be looked up: fonts for any script also have the Latin letters of Europe,
// which end at U+024F.
bool in_every_font(char32_t c) { return c <= 0x24F; }

// True for characters without a shape of their own, which only change how their neighbours are drawn:
// joiners, marks of direction, word joiners, variation selectors and the byte order mark.
bool has_no_shape(char32_t c) {
  return (c >= 0x200B && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) || (c >= 0x2060 && c <= 0x206F) ||
         (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF;
}

/// The characters without a font in the texts of one language, and the place of the first of these texts.
struct Missing {
  core::Place place;
  std::string characters;
};

class Search {
 public:
  Search(const Protocol& protocol, const std::function<bool(char32_t)>& drawable)
      : languages_(protocol.languages), drawable_(drawable) {}

  /// `language` is that of the texts in `value`; "" for texts that are shown in every language.
  void look(const std::string& key, const core::Place& place, const core::Value& value,
            const std::string& language = "") {
    std::string missing;
    collect(value, language.empty() ? missing : of_languages[language].characters);
    if (auto& first = of_languages[language]; first.place.line == 0 && !first.characters.empty())
      first.place = place;
    if (!missing.empty())
      everywhere.push_back({place,
                            phrase("\"%1\" has characters that no font on this machine can draw: %2",
                                   {plain(key), plain(missing)}),
                            advice()});
    const auto within = [&](const std::string& name) {
      return std::find(languages_.begin(), languages_.end(), name) == languages_.end() ? language : name;
    };
    for (const auto& entry : value.entries)
      look(key + "." + entry.key, entry.place, entry.value, within(entry.key));
    for (const auto& item : value.items)
      for (const auto& entry : item.entries)
        look(key + "." + entry.key, entry.place, entry.value, within(entry.key));
  }

  static core::Phrase advice() {
    return phrase("use other characters, or install a font for them; fonts-noto-core and fonts-noto-cjk together "
                  "cover almost all scripts");
  }

  std::vector<core::Problem> everywhere;
  std::map<std::string, Missing> of_languages;

 private:
  void collect(const core::Value& value, std::string& missing) {
    for (const char32_t code : core::code_points(value.string)) {
      const auto bytes = core::utf8(code);
      if (!in_every_font(code) && !has_no_shape(code) && missing.find(bytes) == std::string::npos &&
          !drawable_(code))
        missing +=
            (missing.empty() ? "" : ", ") + fmt::format("{} (U+{:04X})", bytes, static_cast<unsigned>(code));
    }
    for (const auto& item : value.items)
      if (item.kind == core::Value::Kind::string) collect(item, missing);
  }

  const std::vector<std::string>& languages_;
  const std::function<bool(char32_t)>& drawable_;
};

}  // namespace

Drawable drawn_with(const Protocol& protocol, const std::function<bool(char32_t)>& drawable) {
  Search search(protocol, drawable);
  for (const auto& entry : core::parse_toml(protocol.source, protocol.path).entries)
    search.look(entry.key, entry.place, entry.value);
  Drawable result;
  result.problems = std::move(search.everywhere);
  for (const auto& language : protocol.languages) {
    const auto& [place, characters] = search.of_languages[language];
    if (characters.empty())
      result.languages.push_back(language);
    else
      result.other_languages.push_back(
          {place,
           phrase("this station does not offer the language %1, because no font on this machine can draw: %2",
                  {plain(language), plain(characters)}),
           Search::advice()});
  }
  if (result.languages.empty())
    for (auto& problem : result.other_languages) result.problems.push_back(std::move(problem));
  if (result.languages.empty()) result.other_languages.clear();
  return result;
}

}  // namespace turnpoint::protocol
