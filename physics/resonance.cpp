// Resonances: the zeros of the lossless mode's displacement at the drive edge.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;

// Pruefer phase of the lossless mode at the drive edge: continuous and rising in frequency, a multiple of pi
// exactly at the resonances.
class Phase {
 public:
  explicit Phase(const Surface& surface) : surface_(surface), taper_(surface) {}

  double operator()(double frequency_Hz) const {
    const TaylorMarch march(taper_, march_equation(surface_, frequency_Hz, Model::mode, Losses::left_out));
    const double v = march.value(0).mantissa.real();
    const double rising = -march.slope(0).mantissa.real() / wavenumber_per_m(surface_, frequency_Hz);
    // The solution starts positive at the tip; each zero passed adds pi and turns the sign.
    const int zeros = march.zeros();
    const double sign = zeros % 2 == 0 ? 1 : -1;
    return pi * zeros + std::acos(std::clamp(sign * rising / std::hypot(v, rising), -1.0, 1.0));
  }

 private:
  Surface surface_;
  Taper taper_;
};

// Frequency at which the phase reaches `target`, by safeguarded secants from a bracket.
double solve(const Phase& phase, double target, double low, double f_low, double high, double f_high) {
  double x = low;
  for (int i = 0; i < 60 && high - low > 1e-13 * high; ++i) {
    x = i % 4 == 3 ? 0.5 * (low + high) : low + (high - low) * f_low / (f_low - f_high);
    if (!(x > low && x < high)) x = 0.5 * (low + high);
    const double f = phase(x) - target;
    if (f == 0) return x;
    (f < 0 ? low : high) = x;
    (f < 0 ? f_low : f_high) = f;
    if (std::abs(f) < 1e-12) break;
  }
  return x;
}

// The resonance number n (1, 2, ...), searched outward from a frequency of known phase.
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
      return a < b ? solve(phase, target, a, fa, b, fb) : solve(phase, target, b, fb, a, fa);
    }
    a = b;
    fa = fb;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> nearest_resonance_Hz(const Surface& surface, double frequency_Hz) {
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
  const Phase phase(surface);
  std::vector<double> found;
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
