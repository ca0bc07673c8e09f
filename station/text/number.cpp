#include "station/text/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace turnpoint::text {

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

namespace {

// The round constants are the fractional parts of the cube roots of the first 64 primes, the start values
// those of the square roots of the first 8: computed here, so that no table can be mistyped.
std::uint32_t fractional_bits(unsigned prime, int root) {
  // The largest integer n with n^root <= prime * 2^(32 root), by bisection in 128 bits; its low 32 bits.
  __extension__ using Wide = unsigned __int128;
  const auto too_large = [&](std::uint64_t n) {
    if (root == 2) return Wide(n) * n > (Wide(prime) << 64);
    const Wide limit = Wide(prime) << 96;
    return Wide(n) * n > limit / n;
  };
  std::uint64_t low = 0, high = std::uint64_t{1} << 37;
  while (high - low > 1) {
    const auto middle = low + (high - low) / 2;
    (too_large(middle) ? high : low) = middle;
  }
  return static_cast<std::uint32_t>(low);
}

struct Constants {
  std::array<std::uint32_t, 64> round;
  std::array<std::uint32_t, 8> start;
  Constants() : round{}, start{} {
    std::size_t n = 0;
    for (unsigned candidate = 2; n < 64; ++candidate) {
      bool prime = true;
      for (unsigned d = 2; d * d <= candidate; ++d) prime = prime && candidate % d != 0;
      if (!prime) continue;
      round[n] = fractional_bits(candidate, 3);
      if (n < 8) start[n] = fractional_bits(candidate, 2);
      ++n;
    }
  }
};

std::uint32_t rotate(std::uint32_t x, int n) { return (x >> n) | (x << (32 - n)); }

void compress(std::array<std::uint32_t, 8>& state, const unsigned char* block, const Constants& constants) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t i = 0; i < 16; ++i)
    w[i] = std::uint32_t(block[4 * i]) << 24 | std::uint32_t(block[4 * i + 1]) << 16 |
           std::uint32_t(block[4 * i + 2]) << 8 | std::uint32_t(block[4 * i + 3]);
  for (std::size_t i = 16; i < 64; ++i) {
    const auto s0 = rotate(w[i - 15], 7) ^ rotate(w[i - 15], 18) ^ (w[i - 15] >> 3);
    const auto s1 = rotate(w[i - 2], 17) ^ rotate(w[i - 2], 19) ^ (w[i - 2] >> 10);
    w[i] = w[i - 16] + s0 + w[i - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t i = 0; i < 64; ++i) {
    const auto t1 =
        h + (rotate(e, 6) ^ rotate(e, 11) ^ rotate(e, 25)) + ((e & f) ^ (~e & g)) + constants.round[i] + w[i];
    const auto t2 = (rotate(a, 2) ^ rotate(a, 13) ^ rotate(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
  }
  const std::array<std::uint32_t, 8> add{a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state[i] += add[i];
}

}  // namespace

std::string sha256(const std::string& bytes) {
  static const Constants constants;
  std::string padded = bytes;
  padded.push_back('\x80');
  while (padded.size() % 64 != 56) padded.push_back('\0');
  const std::uint64_t bits = 8 * static_cast<std::uint64_t>(bytes.size());
  for (int shift = 56; shift >= 0; shift -= 8) padded.push_back(static_cast<char>(bits >> shift & 0xff));
  auto state = constants.start;
  for (std::size_t i = 0; i < padded.size(); i += 64)
    compress(state, reinterpret_cast<const unsigned char*>(padded.data()) + i, constants);
  std::string hex;
  for (const auto word : state) hex += fmt::format("{:08x}", word);
  return hex;
}

}  // namespace turnpoint::text
