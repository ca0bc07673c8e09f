#pragma once
#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <string>

/// The number in this environment variable, which makes a test longer than usual; `usual` if it is not set.
/// Throws std::invalid_argument if it holds anything but a whole number.
inline int number_from(const char* variable, int usual) {
  const char* const given = std::getenv(variable);
  if (given == nullptr) return usual;
  const std::string text = given;
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(std::string(variable) + ": \"" + text + "\" is not a whole number");
  return number;
}
