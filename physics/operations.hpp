#pragma once
// Counts what the solvers compute, for benchmarks and tests: unlike a time, the count is the same in every
// run and on every machine.

namespace turnpoint::physics {

// The floating-point operations that the solvers have done on this thread so far. Real additions and
// multiplications count 1, complex ones 2 and 6; exponentials, roots and logarithms count
// `function_operations`. The difference between two calls is the work in between. It is computed from the
// sizes of the matrices and series, and nothing depends on it. Left out are evaluations of the taper and
// whatever is done once for a call. Each thread has a count of its own.
double operations_done();

inline constexpr double function_operations = 20;

// What the solvers add to the count: any number of operations, and those of common steps with complex dense
// matrices. `eliminated` of the `size` unknowns of a symmetric matrix are eliminated; a matrix of `size` rows
// is factorised with pivoting and solved for `right_sides` vectors.
void count_operations(double operations);
void count_elimination(double size, double eliminated);
void count_factorisation(double size, double right_sides);

}  // namespace turnpoint::physics
