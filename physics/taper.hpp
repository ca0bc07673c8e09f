#pragma once
// The half-width as a function of x, with the positions and derivatives that the solvers need.
#include <optional>
#include <vector>

#include "physics/monotone_cubic.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

// The half-width W(x) of a surface on [0, length_m]. Immutable; functions marked const are thread-safe.
class Taper {
 public:
  explicit Taper(const Surface& surface);

  double half_width_m(double x_m) const;
  double slope(double x_m) const;  // the derivative dW/dx, which is negative
  // d2W/dx2. For a tabulated taper it jumps at the points of the table.
  double second_derivative(double x_m) const;
  // Position at which the half-width has this value; empty if outside [0, length_m].
  std::optional<double> position_m(double half_width_m) const;
  // Like position_m(), but a linear or exponential taper is continued beyond the ends of the surface. Empty
  // if a tabulated taper does not contain this half-width.
  std::optional<double> position_continued_m(double half_width_m) const;
  double length_m() const { return length_m_; }
  // Position where the sides of a linear taper meet; empty for other tapers.
  std::optional<double> apex_m() const;
  // Largest x < x_m at which a derivative of W jumps; 0 if there is none.
  double previous_knot_m(double x_m) const;
  const TaperForm& form() const { return form_; }
  const MonotoneCubic& table() const { return table_; }

 private:
  TaperForm form_;
  MonotoneCubic table_;
  double length_m_;
};

}  // namespace turnpoint::physics
