#pragma once
#include <cstdint>

namespace turnpoint::audio {

/// A code for recording equipment, as a train of pulses on the marker channel, from the frame of its event
/// on. It has a start (one bit high, one bit low), eight bits of the code, and four check bits. A 1 is half a
/// bit high, then half a bit low; a 0 is the reverse. Each part is high as long as it is low, so an output
/// without DC can transmit it. The most significant bit comes first. Codes are 1 to 255.
inline constexpr int trigger_bits = 14;
inline constexpr int trigger_half_bits = 2 * trigger_bits;
/// Bits of silence that a code needs before and after itself.
inline constexpr int trigger_quiet_bits = 1;

/// The four check bits of a code: a CRC with the polynomial x^4 + x + 1. They detect all errors of one or two
/// bits.
constexpr std::uint32_t trigger_check(std::uint32_t code) noexcept {
  std::uint32_t remainder = code << 4;
  for (int bit = 11; bit >= 4; --bit)
    if (remainder >> bit & 1) remainder ^= 0b10011u << (bit - 4);
  return remainder;
}

/// The half bits of a code: bit 27 is the first half bit, and 1 means high. Code 0 means "no code" and gives
/// 0.
constexpr std::uint32_t trigger_pattern(std::uint8_t code) noexcept {
  if (code == 0) return 0;
  std::uint32_t pattern = 0b1100;
  const std::uint32_t word = std::uint32_t{code} << 4 | trigger_check(code);
  for (int bit = 11; bit >= 0; --bit) pattern = pattern << 2 | (word >> bit & 1 ? 0b10 : 0b01);
  return pattern;
}

/// Sign of the pulse train (1 or -1) during this half bit, counted from 0.
constexpr int trigger_wave(std::uint32_t pattern, int half_bit) noexcept {
  return pattern >> (trigger_half_bits - 1 - half_bit) & 1 ? 1 : -1;
}

}  // namespace turnpoint::audio
