#include "station/core/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace turnpoint::core {

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "none";
  const double magnitude = std::fabs(value);
  if (magnitude == 0.0) return "0";
  if (magnitude < 1e-4 || magnitude >= 1e9) return fmt::format("{:.{}g}", value, digits);
  const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(magnitude))));
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string estimated(double value, double uncertainty) {
  constexpr int most_decimals = 9;
  if (!std::isfinite(value) || !std::isfinite(uncertainty) || !(uncertainty > 0)) return number(value, 3);
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(uncertainty))));
  if (decimals > most_decimals || std::fabs(value) >= 1e9) return number(value, 3);
  auto text = fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_of("123456789") == std::string::npos && text[0] == '-') text.erase(0, 1);
  return text;
}

double uncertainty(double value, double low, double high) {
  const double nearer = std::min(value - low, high - value);
  return nearer > 0 ? nearer / 2 : (high - low) / 4;
}

std::string exact(double value) {
  if (!std::isfinite(value)) return "n/a";
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::optional<double> read_number(const std::string& text) {
  double value = 0;
  const auto* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc{} && read.ptr == end ? std::optional(value) : std::nullopt;
}

}  // namespace turnpoint::core
