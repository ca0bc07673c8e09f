#pragma once
// Monotone piecewise cubics through points (Fritsch & Carlson 1980, with Fritsch & Butland's slopes).
#include <span>
#include <vector>

namespace turnpoint::physics {

// One cubic on [x0, x1]: value = y0 + t (c1 + t (c2 + t c3)), t = x - x0.
struct Cubic {
  double x0, x1;
  double y0, c1, c2, c3;
  double value(double x) const {
    const double t = x - x0;
    return y0 + t * (c1 + t * (c2 + t * c3));
  }
  double slope(double x) const {
    const double t = x - x0;
    return c1 + t * (2 * c2 + t * 3 * c3);
  }
};

// A monotone function with continuous slope through strictly monotone points. (With given slopes, it is
// monotone if each of them is at most three times that of the chords beside it.) Beyond the first and last
// point, the first and last cubic continue. Throws std::invalid_argument for fewer than two points or
// unsorted x.
class MonotoneCubic {
 public:
  MonotoneCubic() = default;
  // With slopes at the points, these are used.
  MonotoneCubic(std::span<const double> x, std::span<const double> y, std::span<const double> slopes = {});

  double operator()(double x) const { return piece(x).value(x); }
  double slope(double x) const { return piece(x).slope(x); }
  const Cubic& piece(double x) const;
  const std::vector<Cubic>& pieces() const { return pieces_; }
  // The x at which the function has the value y. The points must be strictly monotone, and y inside their
  // range (to rounding).
  double inverse(double y) const;

 private:
  std::vector<Cubic> pieces_;
};

}  // namespace turnpoint::physics
