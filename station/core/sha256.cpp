#include "station/core/sha256.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "station/core/number.hpp"

namespace turnpoint::core {

namespace {

// The standard defines the round constants as the first 32 bits of the fractional parts of the cube roots of
// the first 64 primes, and the start values as those of the square roots of the first 8 primes. They are
// computed here, because a table could contain a typing error.
std::uint32_t fractional_bits(unsigned prime, int root) {
  // Finds, by bisection in 128 bits, the largest integer n with n^root <= prime * 2^(32 root), and returns
  // its low 32 bits.
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

const Constants& constants() {
  static const Constants all;
  return all;
}

const unsigned char* bytes_at(std::string_view bytes, std::size_t at) {
  return reinterpret_cast<const unsigned char*>(bytes.data()) + at;
}

}  // namespace

Sha256::Sha256() : state_(constants().start) {}

void Sha256::add(std::string_view bytes) {
  size_ += bytes.size();
  if (!rest_.empty()) {
    const auto wanted = std::min(bytes.size(), 64 - rest_.size());
    rest_ += bytes.substr(0, wanted);
    bytes.remove_prefix(wanted);
    if (rest_.size() < 64) return;
    compress(state_, bytes_at(rest_, 0), constants());
    rest_.clear();
  }
  const auto whole = bytes.size() - bytes.size() % 64;
  for (std::size_t i = 0; i < whole; i += 64) compress(state_, bytes_at(bytes, i), constants());
  rest_ = bytes.substr(whole);
}

std::string Sha256::hex() {
  const std::uint64_t bits = 8 * size_;
  std::string padding(1, '\x80');
  while ((size_ + padding.size()) % 64 != 56) padding.push_back('\0');
  for (int shift = 56; shift >= 0; shift -= 8) padding.push_back(static_cast<char>(bits >> shift & 0xff));
  add(padding);
  std::string text;
  for (const auto word : state_) text += fmt::format("{:08x}", word);
  return text;
}

std::string sha256(const std::string& bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace turnpoint::core
