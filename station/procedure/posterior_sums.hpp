#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

// The sums of Posterior. They are vectorised, and always add in the same order, so that the results do not
// depend on the compiler or the machine.
namespace turnpoint::procedure {

/// A sum of products is made of this many partial sums, which are computed in parallel.
constexpr std::size_t kLanes = 8;

struct Products {
  std::array<double, kLanes> lane{};
  double rest = 0;

  double sum() const {
    return rest + ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
  }
};

/// Adds x * y to the first sum and x * z to the second. Computing both together is faster, because neither
/// waits for the other.
void add(Products& first, Products& second, const double* x, const double* y, const double* z, std::size_t n);

/// The expected entropies of this many stimuli are computed side by side. Each stimulus has sums of its own,
/// in the same order of additions as if it were computed alone.
constexpr std::size_t kAbreast = 4;
/// The logarithms of this many groups are computed together.
constexpr std::size_t kBatch = 128;

/// Adds to the sums of each point's group the point's weight times its range times the value of the function,
/// for kAbreast stimuli. `values` has kAbreast values for each shape.
void add_to_groups(double* __restrict sums, const std::uint32_t* __restrict groups,
                   const double* __restrict weights, const double* __restrict ranges,
                   const double* __restrict values, std::size_t shapes, std::size_t ends);

/// Adds to `totals` the weighted entropies of the answer in `n` groups, at most kBatch, for kAbreast stimuli.
/// `ones` are the groups' weights of answer 1.
void add_entropies(double* __restrict totals, const double* __restrict ones, const double* __restrict weights,
                   std::size_t n);

}  // namespace turnpoint::procedure
