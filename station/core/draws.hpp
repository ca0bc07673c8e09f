#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace turnpoint::core {

/// The purpose of a random draw. Recorded data depend on these numbers: never change one, only add new ones.
enum class Stream : std::uint32_t {
  level_order = 1,
  factor_level = 2,
  roving = 3,
  foreperiod = 4,
  intertrial = 5,
  catch_trial = 6,
  interval_order = 7,
  interleave = 8,
  practice = 9,
  warmup = 10,
  observer = 11,
  bootstrap = 12,
  adjustment_start = 13,
  masking_noise = 14,
  questionnaire = 15,
  factor_value = 16,
  factor_list = 17,
  asking_again = 18,
};

/// Identifies a random draw. The same key always gives the same numbers, whatever else was drawn. Repeating a
/// trial, or making it void, therefore does not change the draws of other trials.
struct DrawKey {
  std::uint64_t seed = 0;
  Stream stream = Stream::level_order;
  int block = 0, attempt = 0;
  int trial = 0;
};

/// Turns a counter and a key into 128 random bits, with ten rounds of Philox 4x32 (Salmon et al., SC 2011).
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// A sequence of random numbers for one key. It has the same bits on every machine, with and without fused
/// multiply-add, because it uses only integer arithmetic and exact scaling.
class Draws {
 public:
  explicit Draws(const DrawKey& key) : key_(key) {}

  std::uint64_t bits();
  /// Returns a number uniform in [0, 1), a multiple of 2^-53.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns an integer uniform in 0 ... n - 1, for n > 0. Rejection avoids the bias of a plain remainder.
  std::uint64_t below(std::uint64_t n);
  /// Returns a standard normal number. Uses Marsaglia's polar method and the logarithm of elementary.hpp.
  double normal();

  /// Shuffles in place (Fisher-Yates).
  template <typename T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  DrawKey key_;
  std::uint32_t index_ = 0;
  std::uint64_t spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace turnpoint::core
