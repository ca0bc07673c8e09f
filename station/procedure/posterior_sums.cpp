#include "station/procedure/posterior_sums.hpp"

#include <cstring>

#include "station/core/elementary.hpp"
#include "station/core/instruction_sets.hpp"

namespace turnpoint::procedure {

namespace {

using Quad = double __attribute__((vector_size(32)));

}  // namespace

// The partial sums are copied to local variables, which cannot overlap the inputs, so that the compiler can
// keep them in registers.
TURNPOINT_CLONES
void add(Products& first, Products& second, const double* x, const double* y, const double* z,
         std::size_t n) {
  Quad one_low, one_high, two_low, two_high, value, by;
  std::memcpy(&one_low, &first.lane[0], sizeof one_low);
  std::memcpy(&one_high, &first.lane[4], sizeof one_high);
  std::memcpy(&two_low, &second.lane[0], sizeof two_low);
  std::memcpy(&two_high, &second.lane[4], sizeof two_high);
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    std::memcpy(&value, x + i, sizeof value);
    std::memcpy(&by, y + i, sizeof by);
    one_low += value * by;
    std::memcpy(&by, z + i, sizeof by);
    two_low += value * by;
    std::memcpy(&value, x + i + 4, sizeof value);
    std::memcpy(&by, y + i + 4, sizeof by);
    one_high += value * by;
    std::memcpy(&by, z + i + 4, sizeof by);
    two_high += value * by;
  }
  double one_rest = first.rest, two_rest = second.rest;
  for (; i < n; ++i) one_rest += x[i] * y[i], two_rest += x[i] * z[i];
  std::memcpy(&first.lane[0], &one_low, sizeof one_low);
  std::memcpy(&first.lane[4], &one_high, sizeof one_high);
  std::memcpy(&second.lane[0], &two_low, sizeof two_low);
  std::memcpy(&second.lane[4], &two_high, sizeof two_high);
  first.rest = one_rest, second.rest = two_rest;
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
