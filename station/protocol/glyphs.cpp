#include "station/protocol/glyphs.hpp"

#include <fmt/format.h>

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

struct Character {
  char32_t code;
  std::string bytes;
};

// Splits a text into characters. The text is valid UTF-8, because the reader of TOML files refuses any other.
std::vector<Character> characters(const std::string& text) {
  std::vector<Character> list;
  for (const char byte : text) {
    const auto value = static_cast<unsigned char>(byte);
    if ((value & 0xC0) == 0x80 && !list.empty()) {
      list.back().code = (list.back().code << 6) | (value & 0x3F);
    } else {
      const unsigned char mask = value < 0x80 ? 0x7F : value < 0xE0 ? 0x1F : value < 0xF0 ? 0x0F : 0x07;
      list.push_back({static_cast<char32_t>(value & mask), ""});
    }
    list.back().bytes += byte;
  }
  return list;
}

class Search {
 public:
  explicit Search(const std::function<bool(char32_t)>& drawable) : drawable_(drawable) {}

  void look(const std::string& key, const core::Place& place, const core::Value& value) {
    std::string missing;
    collect(value, missing);
    if (!missing.empty())
      found.push_back({place,
                       phrase("\"%1\" has characters that no font on this machine can draw: %2",
                              {plain(key), plain(missing)}),
                       phrase("use other characters, or install a font for them; fonts-noto-core and "
                              "fonts-noto-cjk together cover almost all scripts")});
    for (const auto& entry : value.entries) look(key + "." + entry.key, entry.place, entry.value);
    for (const auto& item : value.items)
      for (const auto& entry : item.entries) look(key + "." + entry.key, entry.place, entry.value);
  }

  std::vector<core::Problem> found;

 private:
  void collect(const core::Value& value, std::string& missing) {
    for (const auto& [code, bytes] : characters(value.string))
      if (!in_every_font(code) && !has_no_shape(code) && missing.find(bytes) == std::string::npos &&
          !drawable_(code))
        missing +=
            (missing.empty() ? "" : ", ") + fmt::format("{} (U+{:04X})", bytes, static_cast<unsigned>(code));
    for (const auto& item : value.items)
      if (item.kind == core::Value::Kind::string) collect(item, missing);
  }

  const std::function<bool(char32_t)>& drawable_;
};

}  // namespace

std::vector<core::Problem> undrawable(const Protocol& protocol,
                                      const std::function<bool(char32_t)>& drawable) {
  Search search(drawable);
  for (const auto& entry : core::parse_toml(protocol.source, protocol.path).entries)
    search.look(entry.key, entry.place, entry.value);
  return search.found;
}

}  // namespace turnpoint::protocol
