#pragma once
#include <cstdint>

namespace turnpoint::drive {

/// A random number that depends only on the counter, by SplitMix64's finaliser (Steele, Lea, Flood 2014).
/// Dither and noise are therefore the same wherever rendering starts.
inline std::uint64_t hashed(std::uint64_t counter) noexcept {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// A random number in (-1, 1) with a triangular distribution of variance 1/6. It is the sum of two
/// independent uniform numbers in (-1/2, 1/2), one from each half of the bits.
inline double triangular(std::uint64_t bits) noexcept {
  const auto high = static_cast<std::int32_t>(bits >> 32), low = static_cast<std::int32_t>(bits);
  return (static_cast<double>(high) + static_cast<double>(low) + 1.0) * 0x1p-32;
}

/// A random number, uniform in (-1, 1).
inline double uniform(std::uint64_t bits) noexcept {
  return (static_cast<double>(static_cast<std::int64_t>(bits) >> 11) + 0.5) * 0x1p-52;
}

}  // namespace turnpoint::drive
