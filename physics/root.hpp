// Finds roots of a function between two points at which its sign differs: by halving, by Newton's steps, or
// by false position. Only headers, without allocation.
#pragma once

#include <algorithm>
#include <cmath>

namespace turnpoint::physics {

// An interval whose ends have different signs of the function: it is above 0 at `above` (which may be the
// left or the right end), and 0 or below at the other end.
struct Bracket {
  double above;      // f > 0
  double not_above;  // f <= 0

  double middle() const { return 0.5 * (above + not_above); }
  double width() const { return std::abs(above - not_above); }
  // Whether x is strictly between the ends; false for a NaN.
  bool inside(double x) const { return x > std::min(above, not_above) && x < std::max(above, not_above); }
  void replace(bool is_above, double x) { (is_above ? above : not_above) = x; }
};

// Each search below also ends if there is no number left between the ends, or after `most` steps. This bounds
// the work if the root is at 0 or rounding keeps steps from becoming small.

// Halves the bracket until done(bracket). For functions of which only the sign is known.
template <typename IsAbove, typename Done>
Bracket bisect(Bracket bracket, IsAbove&& is_above, Done&& done, int most = 200) {
  for (int i = 0; i < most && !done(bracket); ++i) {
    const double x = bracket.middle();
    if (!bracket.inside(x)) break;
    bracket.replace(is_above(x), x);
  }
  return bracket;
}

// Halves the bracket until no number is left between its ends.
template <typename IsAbove>
Bracket bisect(Bracket bracket, IsAbove&& is_above) {
  return bisect(bracket, is_above, [](const Bracket&) { return false; });
}

// The input of a Newton step: the function's value at x, and the point where its tangent there is 0. If the
// tangent has no such point, the result may be NaN or any number outside the bracket.
struct Tangent {
  double f, meets_0;
};

// Takes Newton's steps from x; a step that would leave the bracket goes to its middle instead. Ends at a
// point where the function is 0, or after a step from x to `point` for which close(point, x) is true.
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

// The two ends of an interval with the function's values, which differ in sign.
struct Chord {
  double left, f_left, right, f_right;

  double middle() const { return 0.5 * (left + right); }
  double width() const { return right - left; }
  double meets_0() const { return left + (right - left) * f_left / (f_left - f_right); }
};

// What false position does if it converges slowly because one end never moves.
struct Creeping {
  int halve_every;            // after every this many steps, one goes to the middle
  bool halve_values = false;  // Illinois method: if an end stays a second time, its value is halved
};

// Searches by false position until |function| is at most `enough`, done(chord) is true, or no number is left
// between the ends. Returns the point whose value is at most `enough`, otherwise the middle of the last
// chord.
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
