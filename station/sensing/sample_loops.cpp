#include "station/sensing/sample_loops.hpp"

#include <cmath>
#include <cstdint>

#include "station/core/instruction_sets.hpp"

namespace turnpoint::sensing::loops {
namespace {

/// The width of a register: AVX2 has 32 bytes, every other 64-bit processor at least 16.
#ifdef __x86_64__
constexpr std::size_t kVectorBytes = 32;
#else
constexpr std::size_t kVectorBytes = 16;
#endif

/// Numbers in a vector register, at any address.
template <class Number>
struct Vector {
  using Type [[gnu::vector_size(kVectorBytes)]] = Number;
  static constexpr std::size_t lanes = kVectorBytes / sizeof(Number);
  [[gnu::always_inline]] static inline Type load(const Number* from) noexcept {
    Type made;
    __builtin_memcpy(&made, from, kVectorBytes);
    return made;
  }
  [[gnu::always_inline]] static inline void store(const Type& vector, Number* to) noexcept {
    __builtin_memcpy(to, &vector, kVectorBytes);
  }
};

template <std::size_t inputs>
[[gnu::always_inline]] inline void tones_of(const double* x, std::size_t frames, const double* table,
                                            std::size_t columns, double* sums) noexcept {
  using V = Vector<double>;
  constexpr std::size_t parts = kTones / V::lanes;
  V::Type sum[inputs][parts] = {};
  for (std::size_t n = 0; n < frames; ++n, table += columns)
    for (std::size_t k = 0; k < parts; ++k) {
      const auto t = V::load(table + k * V::lanes);
      for (std::size_t i = 0; i < inputs; ++i) sum[i][k] += x[i * frames + n] * t;
    }
  for (std::size_t i = 0; i < inputs; ++i)
    for (std::size_t k = 0; k < parts; ++k) V::store(sum[i][k], sums + i * columns + k * V::lanes);
}

/// Exchanges the first and the second group of four floats, if the vector has two.
template <class V>
[[gnu::always_inline]] inline V mirrored(const V& v) noexcept {
  if constexpr (sizeof(V) == 16)
    return v;
  else
    return __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
}

}  // namespace

TURNPOINT_CLONES void scale(const std::int32_t* samples, std::ptrdiff_t stride, std::int64_t count,
                            double* to) noexcept {
  for (std::int64_t n = 0; n < count; ++n) to[n] = 0x1p-31 * samples[n * stride];
}

TURNPOINT_CLONES void high_pass(const double* s, int frames, int step, double* __restrict y) noexcept {
  for (int n = 0; n < frames; ++n) y[n] = 0.25 * (2 * s[n] - s[n - step] - s[n + step]);
}

// energy() and largest() have eight partial results, so that one operation need not wait for the previous
// one.
TURNPOINT_CLONES double energy(const double* y, int frames) noexcept {
  using V = Vector<double>;
  constexpr int partial = 8, lanes = V::lanes, parts = partial / lanes;
  V::Type sums[parts] = {};
  int n = 0;
  for (; n + partial <= frames; n += partial)
    for (int k = 0; k < parts; ++k) {
      const auto some = V::load(y + n + k * lanes);
      sums[k] += some * some;
    }
  double sum = 0;
  for (; n < frames; ++n) sum += y[n] * y[n];
  for (const auto& part : sums)
    for (int k = 0; k < lanes; ++k) sum += part[k];
  return sum;
}

TURNPOINT_CLONES double largest(const double* s, int frames) noexcept {
  using V = Vector<double>;
  constexpr int partial = 8, lanes = V::lanes, parts = partial / lanes;
  V::Type most[parts] = {};
  int n = 0;
  for (; n + partial <= frames; n += partial)
    for (int k = 0; k < parts; ++k) {
      const auto some = V::load(s + n + k * lanes);
      most[k] = some > most[k] ? some : most[k];
      most[k] = -some > most[k] ? -some : most[k];
    }
  double found = 0;
  for (; n < frames; ++n) found = std::fabs(s[n]) > found ? std::fabs(s[n]) : found;
  for (const auto& part : most)
    for (int k = 0; k < lanes; ++k) found = part[k] > found ? part[k] : found;
  return found;
}

TURNPOINT_CLONES void fold(const double* s, std::size_t half, double* __restrict even,
                           double* __restrict odd) noexcept {
  for (std::size_t n = 0; n < half; ++n) {
    const double after = s[half + n], before = s[half - 1 - n];
    even[n] = after + before;
    odd[n] = after - before;
  }
}

TURNPOINT_CLONES void tones(const double* x, std::size_t inputs, std::size_t frames, const double* table,
                            std::size_t columns, double* sums) noexcept {
  std::size_t i = 0;
  for (; i + 2 <= inputs; i += 2) tones_of<2>(x + i * frames, frames, table, columns, sums + i * columns);
  if (i < inputs) tones_of<1>(x + i * frames, frames, table, columns, sums + i * columns);
}

TURNPOINT_CLONES void pick_four(const std::int32_t* frames, std::int64_t count, const int* channels,
                                std::ptrdiff_t stride, float* to) noexcept {
  using Whole [[gnu::vector_size(16)]] = std::int32_t;
  using Real [[gnu::vector_size(16)]] = float;
  const std::ptrdiff_t a = channels[0], b = channels[1], c = channels[2], d = channels[3];
  const auto convert = [&](const auto& pick) __attribute__((always_inline)) {
    for (std::int64_t n = 0; n < count; ++n, frames += stride, to += 4) {
      const Real real = __builtin_convertvector(pick(), Real);
      __builtin_memcpy(to, &real, sizeof real);
    }
  };
  if (b == a + 1 && c == a + 2 && d == a + 3)  // side by side, as usual: one load instead of four
    convert([&]() __attribute__((always_inline)) {
      Whole whole;
      __builtin_memcpy(&whole, frames + a, sizeof whole);
      return whole;
    });
  else
    convert([&]() __attribute__((always_inline)) {
      return Whole{frames[a], frames[b], frames[c], frames[d]};
    });
}

TURNPOINT_CLONES void carrier(const float* middle, std::int64_t half, const float* even, const float* odd,
                              float* re, float* im) noexcept {
  constexpr std::ptrdiff_t group = 4, steps = 4;  // four partial sums, for n modulo 4
  using V = Vector<float>;
  constexpr std::ptrdiff_t per_vector = V::lanes / group, parts = steps / per_vector;
  V::Type sum_re[parts] = {}, sum_im[parts] = {};
  std::ptrdiff_t n = 0;
  for (; n + steps <= half + 1; n += steps)
    for (std::ptrdiff_t k = 0; k < parts; ++k) {
      const std::ptrdiff_t at = n + k * per_vector;
      const auto after = V::load(middle + group * at);
      const auto before = mirrored(V::load(middle - group * (at + per_vector - 1)));
      sum_re[k] += (after + before) * V::load(even + group * at);
      sum_im[k] += (after - before) * V::load(odd + group * at);
    }
  float all_re[steps * group], all_im[steps * group];
  for (std::ptrdiff_t k = 0; k < parts; ++k) {
    V::store(sum_re[k], all_re + k * per_vector * group);
    V::store(sum_im[k], all_im + k * per_vector * group);
  }
  for (std::ptrdiff_t k = 0; n <= half; ++n, ++k)
    for (std::ptrdiff_t i = 0; i < group; ++i) {
      const float after = middle[group * n + i], before = middle[-group * n + i];
      all_re[k * group + i] += (after + before) * even[group * n + i];
      all_im[k * group + i] += (after - before) * odd[group * n + i];
    }
  for (std::ptrdiff_t i = 0; i < group; ++i) {
    re[i] = (all_re[i] + all_re[group + i]) + (all_re[2 * group + i] + all_re[3 * group + i]);
    im[i] = (all_im[i] + all_im[group + i]) + (all_im[2 * group + i] + all_im[3 * group + i]);
  }
}

TURNPOINT_CLONES void eight(const double* middle, std::int64_t half, const double* taps,
                            double* sums) noexcept {
  constexpr std::ptrdiff_t signals = 8;
  using V = Vector<double>;
  constexpr std::ptrdiff_t lanes = V::lanes, parts = signals / lanes;
  V::Type sum[2][parts] = {};  // for even and odd n
  const auto add = [&](std::ptrdiff_t n, std::size_t odd) __attribute__((always_inline)) {
    for (std::ptrdiff_t k = 0; k < parts; ++k)
      sum[odd][k] +=
          (V::load(middle + signals * n + lanes * k) + V::load(middle - signals * n + lanes * k)) * taps[n];
  };
  std::ptrdiff_t n = 0;
  for (; n + 1 <= half; n += 2) {
    add(n, 0);
    add(n + 1, 1);
  }
  if (n <= half) add(n, 0);
  for (std::ptrdiff_t k = 0; k < parts; ++k) V::store(sum[0][k] + sum[1][k], sums + lanes * k);
}

}  // namespace turnpoint::sensing::loops
