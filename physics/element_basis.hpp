#pragma once
// Polynomials along one element, t in [-1, 1]: continuous for a membrane, with continuous slope for a plate.
#include <array>
#include <cstddef>

namespace turnpoint::physics {

inline constexpr int largest_degree = 12;

struct BasisValues {
  std::array<double, largest_degree + 1> value{}, first{}, second{};
};

// Order of the functions: left vertex (value and slope), bubbles, right vertex. `per_vertex` is 1 or 2.
struct ElementBasis {
  int degree;
  int per_vertex;
  int count() const { return degree + 1; }
  int bubbles() const { return count() - 2 * per_vertex; }
  // Values and derivatives with respect to t. The functions for vertex slopes have unit slope with respect to
  // t, too.
  BasisValues at(double t) const;
};

}  // namespace turnpoint::physics
