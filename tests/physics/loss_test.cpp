// The quality factor of a surface is what a resonance curve shows, whatever carries the wave.
#include <cmath>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/finger.hpp"
#include "physics/friction.hpp"
#include "physics/root.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

// The frequency of a resonance over its width at half of the power, from its curve near f.
template <class Power>
double measured_quality(double f, const Power& power) {
  // the maximum, by golden section within 3 % of f
  double low = 0.97 * f, high = 1.03 * f;
  int best = 0;
  constexpr int points = 240;
  for (int i = 0; i <= points; ++i)
    if (power(low + (high - low) * i / points) > power(low + (high - low) * best / points)) best = i;
  const double step = (high - low) / points, about = low + step * best;
  low = about - step, high = about + step;
  for (int i = 0; i < 30; ++i) {
    const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
    (power(a) < power(b) ? low : high) = power(a) < power(b) ? a : b;
  }
  const double top = 0.5 * (low + high), half = 0.5 * power(top);
  const auto crossing = [&](double away) {
    const auto above = [&](double at) { return power(at) > half; };
    return bisect(
               {top, top + away}, above, [](const Bracket& b) { return b.width() < 1e-3; }, 60)
        .above;
  };
  return top / (crossing(0.01 * f) - crossing(-0.01 * f));
}

Surface plate(PlateTheory theory, Edges edges, double tension_Pa) {
  Surface s = aluminium_plate();
  s.theory = theory;
  s.edges = edges;
  s.tension_Pa = tension_Pa;
  s.bending = Bending::on;
  return s;
}

}  // namespace

TEST_CASE("the half-power width of a resonance is its frequency over the quality factor, for every surface",
          "[physics][loss]") {
  Surface brass = seed_brass();
  for (Surface s :
       {brass, plate(PlateTheory::kirchhoff, Edges::supported, 0),
        plate(PlateTheory::kirchhoff, Edges::supported, 5e8),
        plate(PlateTheory::kirchhoff, Edges::clamped, 0), plate(PlateTheory::kirchhoff, Edges::clamped, 5e8),
        plate(PlateTheory::mindlin, Edges::clamped, 0), plate(PlateTheory::elastic, Edges::clamped, 0)}) {
    s.quality_factor = 200;
    const double f = nearest_resonance_Hz(s, 3e4).value();
    CAPTURE(s.tension_Pa, s.edges == Edges::clamped, name(s.theory), f);
    for (const Model model : {Model::mode, Model::modes}) {
      if (model == Model::modes && s.theory != PlateTheory::kirchhoff) continue;
      const auto power = [&](double at) {
        const auto line = make_centre_line(s, at, model);
        return std::exp(2 *
                        (line->value(*line->last_peak_m()).ln_magnitude() - line->value(0).ln_magnitude()));
      };
      CHECK(measured_quality(f, power) == Approx(200).epsilon(0.02));
    }
  }
}

TEST_CASE("under a finger, the mobility of a plate has resonances of the same width", "[physics][loss]") {
  for (const PlateTheory theory : {PlateTheory::kirchhoff, PlateTheory::mindlin}) {
    Surface s = plate(theory, Edges::clamped, 0);
    s.quality_factor = 200;
    const double f = nearest_resonance_Hz(s, 3e4).value();
    const double x = make_centre_line(s, f, Model::mode)->last_peak_m().value();
    const auto power = [&](double at) {
      return std::norm(finger_load(s, at, {x}, Finger{{0, 0}, 1e-3, 0}).front().mobility_m_per_Ns / at);
    };
    CAPTURE(name(theory), f);
    CHECK(measured_quality(f, power) == Approx(200).epsilon(0.03));
  }
}
