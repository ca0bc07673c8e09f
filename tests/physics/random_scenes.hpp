#pragma once
// Helpers for the tests of error bounds: random numbers, the number of random scenes, and a median.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/number_from.hpp"

namespace turnpoint::physics_test {

// The SplitMix64 random generator, so that the random scenes are the same on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  double spread(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

#if defined(__SANITIZE_ADDRESS__)
inline constexpr int share = 4;  // the release build tests all scenes; with a sanitizer a few are enough
#else
inline constexpr int share = 1;
#endif

// Number of random scenes: `usual`, or the value of TURNPOINT_SCENES, for example 5000 for a long run.
inline int scenes(int usual) { return number_from("TURNPOINT_SCENES", usual / share); }

// Number of the first scene, to make a long run in parts: 0, or the value of TURNPOINT_FIRST_SCENE.
inline int first_scene() { return number_from("TURNPOINT_FIRST_SCENE", 0); }

inline double median(std::vector<double> list) {
  const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  std::nth_element(list.begin(), middle, list.end());
  return *middle;
}

}  // namespace turnpoint::physics_test
