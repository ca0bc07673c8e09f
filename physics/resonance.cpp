// Finds resonances. At a resonance, the displacement of the lossless mode is zero at the drive edge.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/gate.hpp"
#include "physics/root.hpp"
#include "physics/smooth_sides.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;

// The Pruefer phase of the lossless mode at the drive edge. It rises continuously with the frequency and is a
// multiple of pi exactly at the resonances.
class Phase {
 public:
  explicit Phase(const Surface& surface) : surface_(smooth_sides(surface)), taper_(surface_) {}

  double operator()(double frequency_Hz) const {
    const TaylorMarch march(taper_, march_equation(surface_, frequency_Hz, Losses::left_out));
    const double v = march.value(0).mantissa.real();
    const double rising = -march.slope(0).mantissa.real() / wavenumber_per_m(surface_, frequency_Hz);
    // The solution is positive at the tip. Each zero between tip and drive edge adds pi and changes the sign.
    const int zeros = march.zeros();
    const double sign = zeros % 2 == 0 ? 1 : -1;
    // Use an arc tangent: an arc cosine would lose half of the digits near the resonances, where they matter.
    return pi * zeros + std::atan2(std::abs(v), sign * rising);
  }

 private:
  Surface surface_;
  Taper taper_;
};

// Returns the frequency within the bracket at which the phase is `target`.
double solve(const Phase& phase, double target, const Chord& chord) {
  return false_position(
      chord, [&](double f) { return phase(f) - target; }, {4}, 1e-12,
      [](const Chord& c) { return c.width() <= 1e-13 * c.right; });
}

// Finds the frequency of resonance number n (1, 2, ...), starting at a frequency whose phase is known.
std::optional<double> resonance(const Phase& phase, int n, double from_Hz, double at_from) {
  const double target = n * pi;
  double a = from_Hz, fa = at_from - target;
  if (fa == 0) return from_Hz;
  double b = from_Hz;
  double step = std::max(0.02, std::min(0.5, 0.2 * std::abs(fa) / std::max(1.0, at_from)));
  for (int i = 0; i < 200; ++i) {
    b = fa < 0 ? a * (1 + step) : a / (1 + step);
    const double fb = phase(b) - target;
    if ((fb < 0) != (fa < 0) || fb == 0) {
      return solve(phase, target, a < b ? Chord{a, fa, b, fb} : Chord{b, fb, a, fa});
    }
    a = b;
    fa = fb;
  }
  return std::nullopt;
}

// Returns v(0) divided by the last maximum, for the lossless mode of a clamped plate. It changes its sign at
// a resonance.
std::optional<double> plate_response(const Surface& surface, double f) {
  const auto line = make_centre_line(surface, f, Model::mode, Losses::left_out);
  const auto peak = line->last_peak_m();
  if (!peak) return std::nullopt;
  const Scaled top = line->value(*peak), drive = line->value(0);
  return drive.mantissa.real() / top.mantissa.real() *
         std::exp(std::min(300.0, drive.ln_scale - top.ln_scale));
}

// Returns about a fifth of the distance between neighbouring resonances. (From one resonance to the next, one
// more half wave fits between drive edge and turning point.)
double plate_step_Hz(const Surface& surface, double f) {
  const double reach = turning_point_m(surface, f).value_or(surface.length_m);
  return 0.5 * f * pi / (wavenumber_per_m(surface, f) * std::max(reach, 0.05 * surface.length_m));
}

// Finds the resonance between two frequencies whose responses have opposite signs. Near a resonance the
// response is roughly a cosine of frequency with amplitude 1 and many periods, so the relative error of the
// frequency is smaller than the magnitude of the response.
double plate_zero(const Surface& surface, const Chord& chord) {
  // The solution of a thick plate takes long. A relative error of a millionth is enough, because it is far
  // less than the width of a resonance.
  const double enough = surface.theory == PlateTheory::kirchhoff ? 1e-9 : 1e-6;
  return false_position(
      chord, [&](double f) { return plate_response(surface, f).value_or(chord.f_left); }, {8, true}, enough,
      [enough](const Chord& c) { return c.width() <= enough * c.right; });
}

// Walks along the frequency axis in steps and reports each resonance that it passes.
struct PlateWalk {
  double f;
  std::optional<double> response;

  std::optional<double> step(const Surface& surface, double by_Hz) {
    const double from = f;
    f += by_Hz;
    const bool allowed = f > 0 && f <= highest_frequency_Hz(surface);
    const auto before = std::exchange(response, allowed ? plate_response(surface, f) : std::nullopt);
    if (!before || !response || (*before > 0) == (*response > 0)) return std::nullopt;
    return plate_zero(surface,
                      from < f ? Chord{from, *before, f, *response} : Chord{f, *response, from, *before});
  }
};

std::optional<double> nearest_plate_resonance(const Surface& surface, double f) {
  const double step = plate_step_Hz(surface, f);
  PlateWalk up{f, plate_response(surface, f)}, down = up;
  std::optional<double> above, below;
  // Search upwards and downwards in turn. When one direction finds a resonance, the other still takes its
  // step, because it may find a nearer one.
  for (int i = 0; i < 10 && !above && !below; ++i) {
    above = up.step(surface, step);
    below = down.step(surface, -step);
  }
  if (!above || !below) return above ? above : below;
  return *above - f < f - *below ? above : below;
}

std::vector<double> plate_resonances(const Surface& surface, double low_Hz, double high_Hz) {
  std::vector<double> found;
  PlateWalk walk{low_Hz, plate_response(surface, low_Hz)};
  while (walk.f < high_Hz) {
    const auto zero = walk.step(surface, plate_step_Hz(surface, walk.f));
    if (zero && *zero <= high_Hz) found.push_back(*zero);
  }
  return found;
}

}  // namespace

std::optional<double> nearest_resonance_Hz(const Surface& surface, double frequency_Hz) {
  validate(surface, frequency_Hz);
  if (Dispersion(surface).clamped_bending()) return nearest_plate_resonance(surface, frequency_Hz);
  const Phase phase(surface);
  const double here = phase(frequency_Hz);
  const int below = static_cast<int>(std::floor(here / pi));
  const auto above = resonance(phase, below + 1, frequency_Hz, here);
  if (below < 1) return above;
  const auto under = resonance(phase, below, frequency_Hz, here);
  if (!above || !under) return above ? above : under;
  return *above - frequency_Hz < frequency_Hz - *under ? above : under;
}

std::vector<double> resonances_Hz(const Surface& surface, double low_Hz, double high_Hz) {
  validate(surface, low_Hz);
  validate(surface, high_Hz);
  const double most =
      (wavenumber_per_m(surface, high_Hz) - wavenumber_per_m(surface, low_Hz)) * surface.length_m / pi;
  const double limit = surface.theory == PlateTheory::kirchhoff ? 500 : 50;
  require(most <= limit, "number of resonances in the band", most, "at most 500, or 50 on a thick plate");
  if (Dispersion(surface).clamped_bending()) return plate_resonances(surface, low_Hz, high_Hz);
  std::vector<double> found;
  const Phase phase(surface);
  double from = low_Hz, at_from = phase(low_Hz);
  const double last = phase(high_Hz);
  for (int n = static_cast<int>(std::ceil(at_from / pi)); n * pi <= last; ++n) {
    if (n < 1) continue;
    const auto f = resonance(phase, n, from, at_from);
    if (!f) break;
    found.push_back(*f);
    from = *f;
    at_from = n * pi;
  }
  return found;
}

}  // namespace turnpoint::physics
