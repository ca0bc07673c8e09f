#include "physics/plate_theory.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "physics/dispersion.hpp"
#include "physics/gate.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

bool thick_theory_applies(const Surface& s) {
  return s.tension_Pa == 0 && s.edges == Edges::clamped && s.modulus_Pa && s.poisson >= 0 &&
         s.poisson <= 0.49;
}

}  // namespace

std::optional<double> shear_shift_m(const Surface& surface, double f) {
  validate(surface, f);
  if (!thick_theory_applies(surface)) return std::nullopt;
  Surface better = surface;
  better.theory = surface.theory == PlateTheory::kirchhoff ? PlateTheory::mindlin : PlateTheory::elastic;
  const Taper taper(surface);
  const auto here = taper.position_continued_m(cut_off_half_width_m(surface, f));
  const auto there = taper.position_continued_m(cut_off_half_width_m(better, f));
  if (!here || !there) return std::nullopt;
  return *there - *here;
}

TheoryChoice choose_theory(const Surface& surface, std::span<const double> frequencies_Hz,
                           std::optional<double> tolerance_m) {
  validate(surface);
  if (tolerance_m) require_size_or_0("tolerance_m", *tolerance_m);
  TheoryChoice choice;
  if (!thick_theory_applies(surface)) {
    choice.reason = "kirchhoff: shear is modelled for clamped plates without tension only";
    return choice;
  }
  // largest distance between each theory's boundary and that of the elastic cross-section
  double thin = 0, mindlin = 0;
  Surface s = surface;
  for (const double f : frequencies_Hz) {
    s.theory = PlateTheory::kirchhoff;
    const double to_mindlin = shear_shift_m(s, f).value_or(0);
    s.theory = PlateTheory::mindlin;
    const double to_elastic = shear_shift_m(s, f).value_or(0);
    mindlin = std::max(mindlin, std::abs(to_elastic));
    if (std::abs(to_mindlin + to_elastic) > std::abs(thin)) thin = to_mindlin + to_elastic;
  }
  choice.shift_m = thin;
  constexpr double hardly_m = 5e-5;
  choice.theory = std::abs(thin) <= tolerance_m.value_or(hardly_m) ? PlateTheory::kirchhoff
                  : !tolerance_m || mindlin <= *tolerance_m        ? PlateTheory::mindlin
                                                                   : PlateTheory::elastic;
  std::ostringstream text;
  text.precision(3);
  text << name(choice.theory) << ": shear moves the thin plate's boundary by " << thin * 1e3
       << " mm; Mindlin's is " << mindlin * 1e3 << " mm from the elastic section's";
  if (tolerance_m)
    text << "; tolerance " << *tolerance_m * 1e3 << " mm";
  else
    text << "; no tolerance of a boundary";
  choice.reason = text.str();
  return choice;
}

}  // namespace turnpoint::physics
