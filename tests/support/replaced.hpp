#pragma once
#include <stdexcept>
#include <string>

/// Returns `text` with the first `from` replaced. Throws if `text` does not contain it.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("not in the text: " + from);
  return text.replace(at, from.size(), to);
}
