#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

namespace turnpoint::simulation {

/// White noise of variance 1. Its value at a frame depends only on seed, source and frame, so frames may be
/// requested in any order. Each value is the sum of four uniform numbers. It never exceeds 3.5 standard
/// deviations, but is close enough to normal where thousands of samples are averaged.
class Noise {
 public:
  Noise(std::uint64_t seed, std::uint64_t source) : key_(scramble(seed ^ scramble(source + 1))) {}

  double at(std::int64_t frame) const {
    const std::uint64_t bits = scramble(key_ + static_cast<std::uint64_t>(frame) * 0x9E3779B97F4A7C15u);
    const std::uint64_t sum = (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
    return (static_cast<double>(sum) * 0x1p-16 - (2 - 0x1p-15)) * 1.7320508075688772;
  }

 private:
  /// The output function of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014).
  static std::uint64_t scramble(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  std::uint64_t key_;
};

/// Noise of variance 1 with equal power in each octave between two frequencies. It is the sum of white noises
/// behind first-order low-pass filters one octave apart.
class PinkNoise {
 public:
  PinkNoise(std::uint64_t seed, std::uint64_t source, double rate_Hz, double low_Hz, double high_Hz);

  double next();

 private:
  struct Octave {
    Noise noise;
    double keep, take;
    double value;
  };
  std::vector<Octave> octaves_;
  double scale_;
  std::int64_t count_ = 0;
};

}  // namespace turnpoint::simulation
