#include "physics/operations.hpp"

namespace turnpoint::physics {
namespace {

thread_local double done = 0;

constexpr double complex_step = 8;  // a complex multiplication and an addition

// the pairs of unknowns in the triangles that remain, one after the other, until a matrix of n unknowns is
// eliminated
double pairs(double n) { return n > 1 ? (n - 1) * n * (n + 1) / 6 : 0; }

}  // namespace

double operations_done() { return done; }

void count_operations(double operations) { done += operations; }

void count_elimination(double size, double eliminated) {
  done += complex_step * (pairs(size) - pairs(size - eliminated));
}

void count_factorisation(double size, double right_sides) {
  done += complex_step * size * size * (size / 3 + right_sides);
}

}  // namespace turnpoint::physics
