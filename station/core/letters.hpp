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

}  // namespace turnpoint::core
