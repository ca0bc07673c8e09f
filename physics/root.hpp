// Finds a root of a function between two points at which its sign differs: by halving, by Newton steps or by
// false position. Header only; allocates nothing.
#pragma once

#include <algorithm>
#include <cmath>

namespace turnpoint::physics {

// An interval at whose ends a function has different signs. It is above 0 at the end `above`, which may be
// left or right, and 0 or below at the end `not_above`.
struct Bracket {
  double above;      // here the function is > 0
  double not_above;  // here the function is <= 0

  double middle() const { return 0.5 * (above + not_above); }
  double width() const { return std::abs(above - not_above); }
  // Whether x is strictly between the ends; false for a NaN.
  bool inside(double x) const { return x > std::min(above, not_above) && x < std::max(above, not_above); }
  void replace(bool is_above, double x) { (is_above ? above : not_above) = x; }
};

// Each search below also ends after `most` steps, or when no floating-point number is left between the ends.
// This limits the work if the root is at 0, or if rounding prevents small steps.

// Halves the bracket until done(bracket) is true. It needs only the sign of the function.
template <typename IsAbove, typename Done>
Bracket bisect(Bracket bracket, IsAbove&& is_above, Done&& done, int most = 200) {
  for (int i = 0; i < most && !done(bracket); ++i) {
    const double x = bracket.middle();
    if (!bracket.inside(x)) break;
    bracket.replace(is_above(x), x);
  }
  return bracket;
}

// Halves the bracket until there is no floating-point number between its ends.
template <typename IsAbove>
Bracket bisect(Bracket bracket, IsAbove&& is_above) {
  return bisect(bracket, is_above, [](const Bracket&) { return false; });
}

// The result of a Newton step at x: the function's value, and the point where the tangent at x crosses 0. If
// the tangent never crosses 0, `meets_0` may be NaN or any number outside the bracket.
struct Tangent {
  double f, meets_0;
};

// Takes Newton steps from x. A step that would leave the bracket goes to the middle of the bracket instead.
// Ends at a point where the function is 0, or after a step from x to a point p for which close(p, x) is true.
template <typename Function, typename Close>
double newton(Bracket bracket, double x, Function&& tangent, Close&& close, int most = 200) {
  for (int i = 0; i < most; ++i) {
    const Tangent t = tangent(x);
    if (t.f == 0) return x;
    bracket.replace(t.f > 0, x);
    const double next = bracket.inside(t.meets_0) ? t.meets_0 : bracket.middle();
    if (close(next, x)) return next;
    x = next;
  }
  return x;
}

// An interval with the function's values at its ends. The two values differ in sign.
struct Chord {
  double left, f_left, right, f_right;

  double middle() const { return 0.5 * (left + right); }
  double width() const { return right - left; }
  double meets_0() const { return left + (right - left) * f_left / (f_left - f_right); }
};

// False position converges slowly if one end of the interval never moves. These settings choose the remedies.
struct Creeping {
  int halve_every;  // n: every n-th step goes to the middle of the interval
  // Illinois method: halves the function value of an end that did not move for two steps
  bool halve_values = false;
};

// Searches by false position until |function| is at most `enough`, done(chord) is true, or no number is left
// between the ends. Returns the point at which |function| is at most `enough`, or the middle of the last
// chord if there is none.
template <typename Function, typename Done>
double false_position(Chord chord, Function&& f, Creeping creeping, double enough, Done&& done,
                      int most = 100) {
  const bool left_above = chord.f_left > 0;
  int stayed = 0;  // the end that stayed in the last step: -1 left, 1 right
  for (int i = 0; i < most && !done(chord); ++i) {
    double x = chord.meets_0();
    const bool inside = x > chord.left && x < chord.right;
    if (!inside || i % creeping.halve_every == creeping.halve_every - 1) x = chord.middle();
    if (x <= chord.left || x >= chord.right) break;
    const double value = f(x);
    if (std::abs(value) <= enough) return x;
    const bool replaces_left = (value > 0) == left_above;
    (replaces_left ? chord.left : chord.right) = x;
    (replaces_left ? chord.f_left : chord.f_right) = value;
    const int stays = replaces_left ? 1 : -1;
    if (creeping.halve_values && stays == stayed) (replaces_left ? chord.f_right : chord.f_left) *= 0.5;
    stayed = stays;
  }
  return chord.middle();
}

}  // namespace turnpoint::physics
