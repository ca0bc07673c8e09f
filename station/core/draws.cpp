#include "station/core/draws.hpp"

#include <cmath>
#include <stdexcept>

#include "station/core/elementary.hpp"

namespace turnpoint::core {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * c[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57u} * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
    k = {k[0] + 0x9E3779B9u, k[1] + 0xBB67AE85u};
  }
  return c;
}

std::uint64_t Draws::bits() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const auto place =
      static_cast<std::uint32_t>(key_.stream) << 24 | (static_cast<std::uint32_t>(key_.attempt) & 0xffffffu);
  const auto out = philox(
      {index_++, static_cast<std::uint32_t>(key_.trial), static_cast<std::uint32_t>(key_.block), place},
      {static_cast<std::uint32_t>(key_.seed), static_cast<std::uint32_t>(key_.seed >> 32)});
  spare_ = std::uint64_t{out[2]} << 32 | out[3];
  has_spare_ = true;
  return std::uint64_t{out[0]} << 32 | out[1];
}

double Draws::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

std::uint64_t Draws::below(std::uint64_t n) {
  if (n == 0) throw std::invalid_argument("below: n must be at least 1");
  // reject numbers at or above the largest multiple of n, because they would make small remainders more
  // likely
  const std::uint64_t limit = ~std::uint64_t{0} - ~std::uint64_t{0} % n;
  for (;;)
    if (const auto b = bits(); b < limit) return b % n;
}

double Draws::normal() {
  for (;;) {
    const double u = 2 * uniform() - 1, v = 2 * uniform() - 1;
    const double s = u * u + v * v;
    if (s > 0 && s < 1) return u * std::sqrt(-2 * log(s) / s);
  }
}

}  // namespace turnpoint::core
