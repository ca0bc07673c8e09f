#pragma once
// Polynomials along one finite element, with t in [-1, 1]. From element to element, they are continuous for a
// membrane; for a plate their slope is continuous as well.
#include <array>
#include <cstddef>

namespace turnpoint::physics {

inline constexpr int largest_degree = 12;

struct BasisValues {
  std::array<double, largest_degree + 1> value{}, first{}, second{};
};

// The functions are ordered: left vertex, bubbles (zero at both ends), right vertex. `per_vertex` is 1 if a
// vertex has a value only, and 2 if it also has a slope.
struct ElementBasis {
  int degree;
  int per_vertex;
  int count() const { return degree + 1; }
  int bubbles() const { return count() - 2 * per_vertex; }
  // Values and derivatives with respect to t. The function that belongs to the slope at a vertex has unit
  // slope with respect to t there.
  BasisValues at(double t) const;
};

}  // namespace turnpoint::physics
