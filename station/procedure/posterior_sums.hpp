#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

// The sums of Posterior. They are vectorised, and always add in the same order, so that the results do not
// depend on the compiler or the machine.
namespace turnpoint::procedure {

/// A sum of products is made of this many partial sums, which are computed in parallel, and one more for the
/// products that do not fill all of them.
constexpr std::size_t kLanes = 8;

/// The sums of this many stimuli are computed side by side, because none waits for the others. Each stimulus
/// has sums of its own, in the same order of additions as if it were computed alone.
constexpr std::size_t kAbreast = 4;

/// Computes for kAbreast stimuli the sum, over `count` places, of the place's factors times the stimulus' row
/// of the table. Factors and rows have `length` entries. `rows` has for each stimulus the number of the row
/// at each place.
void sum_rows(double* __restrict sums, const double* __restrict factors, const double* __restrict table,
              const std::array<const std::uint32_t*, kAbreast>& rows, const std::size_t* places,
              std::size_t count, std::size_t length);

/// Multiplies the weights of a place, [shape][end], by the probability of the answer, and adds them to
/// `total`, those of a shape first among themselves. The probability of answer 1 is the end's guess plus its
/// range times the value of the shape, and at least `least` from 0 and 1.
void weigh(double* __restrict weights, double& total, const double* __restrict guesses,
           const double* __restrict ranges, const double* __restrict values, std::size_t shapes,
           std::size_t ends, double least, bool one);

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
