#include "physics/edge.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace turnpoint::physics {
namespace {

[[noreturn]] void refuse(std::string_view text) {
  throw std::invalid_argument("edge \"" + std::string(text) +
                              "\" is not known; allowed: turning, peak, p01 ... p99 (p50: half the last "
                              "maximum), friction=m with 0 < m < 1");
}

}  // namespace

Edge parse_edge(std::string_view text) {
  if (text == "turning") return Edge::turning();
  if (text == "peak") return Edge::peak();
  if (text.size() == 3 && text[0] == 'p') {
    int percent = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 3, percent);
    if (error == std::errc{} && end == text.data() + 3 && percent > 0) return Edge::percent(percent / 100.0);
  }
  constexpr std::string_view prefix = "friction=";
  if (text.starts_with(prefix)) {
    double level = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data() + prefix.size(), last, level);
    if (error == std::errc{} && end == last && level > 0 && level < 1) return Edge::friction(level);
  }
  refuse(text);
}

std::string format(const Edge& edge) {
  switch (edge.kind) {
    case Edge::Kind::turning:
      return "turning";
    case Edge::Kind::peak:
      return "peak";
    case Edge::Kind::percent: {
      const int percent = static_cast<int>(std::lround(100 * edge.level));
      return std::string("p") + (percent < 10 ? "0" : "") + std::to_string(percent);
    }
    case Edge::Kind::friction:
      break;
  }
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, edge.level);
  return "friction=" + std::string(digits, error == std::errc{} ? end : digits);
}

}  // namespace turnpoint::physics
