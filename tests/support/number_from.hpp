#pragma once
#include <cstdlib>

/// The number in this environment variable, which makes a test longer than usual; `usual` if it is not set.
inline int number_from(const char* variable, int usual) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? usual : std::atoi(text);
}
