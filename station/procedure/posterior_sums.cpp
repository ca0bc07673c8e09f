#include "station/procedure/posterior_sums.hpp"

#include <algorithm>
#include <cstring>

#include "station/core/elementary.hpp"
#include "station/core/instruction_sets.hpp"

namespace turnpoint::procedure {

namespace {

using Quad = double __attribute__((vector_size(32)));
using Lanes = double __attribute__((vector_size(8 * kLanes)));
static_assert(kAbreast == 4, "a Quad has a value for each stimulus");

}  // namespace

TURNPOINT_CLONES
void sum_rows(double* __restrict sums, const double* __restrict factors, const double* __restrict table,
              const std::array<const std::uint32_t*, kAbreast>& rows, const std::size_t* places,
              std::size_t count, std::size_t length) {
  Lanes sum[kAbreast] = {};
  Quad half[kAbreast] = {};
  Quad rest = {};  // one for each stimulus
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t place = places[k];
    const double* factor = factors + place * length;
    std::array<const double*, kAbreast> row;
    for (std::size_t x = 0; x < kAbreast; ++x) row[x] = table + rows[x][place] * length;
    std::size_t i = 0;
    for (; i + kLanes <= length; i += kLanes) {
      Lanes factor_here, by;
      std::memcpy(&factor_here, factor + i, sizeof factor_here);
#pragma GCC unroll 4
      for (std::size_t x = 0; x < kAbreast; ++x) {
        std::memcpy(&by, row[x] + i, sizeof by);
        sum[x] += factor_here * by;
      }
    }
    if (i + 4 <= length) {
      Quad factor_here, by;
      std::memcpy(&factor_here, factor + i, sizeof factor_here);
#pragma GCC unroll 4
      for (std::size_t x = 0; x < kAbreast; ++x) {
        std::memcpy(&by, row[x] + i, sizeof by);
        half[x] += factor_here * by;
      }
      i += 4;
    }
    for (; i < length; ++i) rest += factor[i] * Quad{row[0][i], row[1][i], row[2][i], row[3][i]};
  }
  for (std::size_t x = 0; x < kAbreast; ++x)
    sums[x] = rest[x] + ((half[x][0] + half[x][1]) + (half[x][2] + half[x][3])) +
              ((sum[x][0] + sum[x][1]) + (sum[x][2] + sum[x][3])) +
              ((sum[x][4] + sum[x][5]) + (sum[x][6] + sum[x][7]));
}

TURNPOINT_CLONES
void weigh(double* __restrict weights, double& total, const double* __restrict guesses,
           const double* __restrict ranges, const double* __restrict values, std::size_t shapes,
           std::size_t ends, double least, bool one) {
  const Quad low = Quad{} + least, high = Quad{} + (1 - least);
  for (std::size_t s = 0; s < shapes; ++s, weights += ends) {
    double part = 0;
    std::size_t e = 0;
    for (; e + 4 <= ends; e += 4) {
      Quad guess, range, weight;
      std::memcpy(&guess, guesses + e, sizeof guess);
      std::memcpy(&range, ranges + e, sizeof range);
      std::memcpy(&weight, weights + e, sizeof weight);
      Quad p = guess + range * values[s];
      p = p < low ? low : p;
      p = high < p ? high : p;
      weight *= one ? p : 1 - p;
      std::memcpy(weights + e, &weight, sizeof weight);
      for (int i = 0; i < 4; ++i) part += weight[i];
    }
    for (; e < ends; ++e) {
      const double p = std::clamp(guesses[e] + ranges[e] * values[s], least, 1 - least);
      part += weights[e] *= one ? p : 1 - p;
    }
    total += part;
  }
}

TURNPOINT_CLONES
void add_to_groups(double* __restrict sums, const std::uint32_t* __restrict groups,
                   const double* __restrict weights, const double* __restrict ranges,
                   const double* __restrict values, std::size_t shapes, std::size_t ends) {
  Quad value, sum;
  for (std::size_t s = 0; s < shapes; ++s) {
    std::memcpy(&value, values + s * kAbreast, sizeof value);
    for (std::size_t e = 0; e < ends; ++e, ++weights, ++groups) {
      double* group = sums + *groups * kAbreast;
      std::memcpy(&sum, group, sizeof sum);
      sum += *weights * (ranges[e] * value);
      std::memcpy(group, &sum, sizeof sum);
    }
  }
}

TURNPOINT_CLONES
void add_entropies(double* __restrict totals, const double* __restrict ones, const double* __restrict weights,
                   std::size_t n) {
  std::array<double, kBatch * kAbreast> one, zero, log_one, log_zero;
  for (std::size_t i = 0; i < n * kAbreast; ++i) {
    const double weight = weights[i / kAbreast], p = ones[i] / (weight > 0 ? weight : 1);
    const bool certain = p <= 0 || p >= 1;
    one[i] = certain ? 1 : p;  // an entropy of 0
    zero[i] = certain ? 1 : 1 - p;
  }
  core::logs({one.data(), n * kAbreast}, log_one);
  core::logs({zero.data(), n * kAbreast}, log_zero);
  Quad total, p, q, log_p, log_q;
  std::memcpy(&total, totals, sizeof total);
  for (std::size_t g = 0; g < n; ++g) {
    if (!(weights[g] > 0)) continue;
    std::memcpy(&p, &one[g * kAbreast], sizeof p);
    std::memcpy(&q, &zero[g * kAbreast], sizeof q);
    std::memcpy(&log_p, &log_one[g * kAbreast], sizeof log_p);
    std::memcpy(&log_q, &log_zero[g * kAbreast], sizeof log_q);
    total += weights[g] * (-p * log_p - q * log_q);
  }
  std::memcpy(totals, &total, sizeof total);
}

}  // namespace turnpoint::procedure
