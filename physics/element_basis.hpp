#pragma once
// Polynomials along one finite element, with t in [-1, 1]. For a membrane they are continuous from element to
// element; for a plate their slopes are continuous too.
#include <array>
#include <cstddef>

namespace turnpoint::physics {

inline constexpr int largest_degree = 12;

struct BasisValues {
  std::array<double, largest_degree + 1> value{}, first{}, second{};
};

// The basis functions of one element come in this order: those of the left vertex, the bubbles (zero at both
// ends), those of the right vertex. `per_vertex` is 1 if a vertex has a value only, and 2 if it also has a
// slope.
struct ElementBasis {
  int degree;
  int per_vertex;
  int count() const { return degree + 1; }
  int bubbles() const { return count() - 2 * per_vertex; }
  // Values of all basis functions, and their derivatives with respect to t. A function that belongs to the
  // slope at a vertex has dvalue/dt = 1 there.
  BasisValues at(double t) const;
};

}  // namespace turnpoint::physics
