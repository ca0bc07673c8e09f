#include "station/audio/sine.hpp"

#include <cmath>

namespace turnpoint::audio {
namespace {
__extension__ using Wide = unsigned __int128;
constexpr double two_pi = 6.283185307179586476925;
}  // namespace

std::uint64_t phase_increment(double frequency_Hz, int rate_Hz) noexcept {
  int exponent = 0;
  // split the frequency into mantissa * 2^(exponent - 53) with an integer mantissa
  const double fraction = std::frexp(frequency_Hz, &exponent);
  auto mantissa = static_cast<Wide>(std::ldexp(fraction, 53));
  const int shift = exponent - 53 + 64;
  if (shift < -60) return 0;
  if (shift >= 0)
    mantissa <<= shift;
  else
    mantissa >>= -shift;
  const auto rate = static_cast<Wide>(rate_Hz);
  return static_cast<std::uint64_t>((mantissa + rate / 2) / rate);
}

std::uint64_t phase_of_angle(double angle_rad) noexcept {
  const double cycles = angle_rad / two_pi;
  const double fraction = cycles - std::floor(cycles);
  // A tiny negative angle rounds up to a whole cycle, which is the same as 0.
  return fraction >= 1 ? 0 : static_cast<std::uint64_t>(fraction * 0x1p64);
}

}  // namespace turnpoint::audio
