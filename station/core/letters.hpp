#pragma once
#include <string>

namespace turnpoint::core {

/// A to Z as a to z, and everything else as it is. std::tolower() depends on the locale of the process.
constexpr char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}
inline std::string lower(std::string text) {
  for (auto& letter : text) letter = lower(letter);
  return text;
}
constexpr char upper(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

/// The characters of a text in valid UTF-8, as Unicode code points.
inline std::u32string code_points(const std::string& utf8) {
  std::u32string list;
  for (const char byte : utf8) {
    const auto value = static_cast<unsigned char>(byte);
    if ((value & 0xC0) == 0x80 && !list.empty()) {
      list.back() = (list.back() << 6) | (value & 0x3F);
    } else {
      const unsigned char mask = value < 0x80 ? 0x7F : value < 0xE0 ? 0x1F : value < 0xF0 ? 0x0F : 0x07;
      list += static_cast<char32_t>(value & mask);
    }
  }
  return list;
}

/// A character in UTF-8.
inline std::string utf8(char32_t code) {
  if (code < 0x80) return {static_cast<char>(code)};
  const auto next = [code](int shift) { return static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x800) return {static_cast<char>(0xC0 | (code >> 6)), next(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0 | (code >> 12)), next(6), next(0)};
  return {static_cast<char>(0xF0 | (code >> 18)), next(12), next(6), next(0)};
}

}  // namespace turnpoint::core
