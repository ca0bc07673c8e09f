#pragma once
// Converts vibration amplitude to relative friction, and back.
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "physics/monotone_cubic.hpp"

namespace turnpoint::physics {

// Mean overpressure in a squeeze film between parallel plates, in units of the ambient pressure p0, in the
// limit of infinite squeeze number. For an excursion e = amplitude / gap in [0, 1) it is sqrt((1 + 3
// e^2/2)/(1 - e^2)) - 1 (Langlois 1962; Salbu 1964).
double squeeze_film_overpressure(double excursion);

// A model in which skin contacts and an air film together carry the load of the fingertip (after Wiertlewski,
// Friesen & Colgate, PNAS 2016). With amplitude a and gap u, the finger's pressure is p = P* exp(-u/u_s) + p0
// overpressure(a/u), where P* exp(-u/u_s) is the part that the contacts carry. Without vibration the gap is
// u_s ln(P*/p): a finger that presses harder comes closer, and its skin stays the same. Relative friction is
// P* exp(-u/u_s)/p, but never below `floor`. The curve is only an illustration: live sessions need a measured
// table. P* and u_s have no source; they give a gap of 4 um at 5 kPa.
struct LoadSharing {
  double pressure_Pa = 5000;  // pressure of the finger on the surface, below `contact_pressure_Pa`
  double floor = 0.1;         // friction that remains at any amplitude; for real skin 0.1 to 0.2
  // the length u_s: the contacts' part of the load falls by a factor e for each u_s of gap
  double decay_length_m = 2e-6;
  double contact_pressure_Pa = 36945.28049465325;  // P*, which would close the gap
  double ambient_Pa = 101325;                      // the ambient pressure p0
};

// One measured point. A table begins at (0, 1), and its relative_friction falls strictly with displacement.
struct FrictionPoint {
  double displacement_m = 0;
  double relative_friction = 1;
  double sd = 0;  // standard deviation of relative_friction
};

// A monotone map from peak displacement to friction, relative to friction on the surface at rest. The
// load-sharing model is solved to rounding accuracy. Its floor f enters as mu^4 = f^4 + (1 - f^4)
// mu_sharing^4, so that the map stays strictly monotone; friction above three times the floor hardly changes.
// The points of a measured table are joined by monotone cubics; beyond the last point, friction stays at the
// last value. Functions marked const are thread-safe.
class FrictionMap {
 public:
  FrictionMap() : FrictionMap(LoadSharing{}) {}
  explicit FrictionMap(const LoadSharing& model);
  // throws std::invalid_argument unless the table begins at (0, 1) and falls strictly
  explicit FrictionMap(std::vector<FrictionPoint> table);

  // Relative friction in (0, 1] for a peak displacement >= 0.
  double relative_friction(double displacement_m) const;
  // The displacement that gives this relative friction. It is 0 for friction 1, and empty below the lowest
  // friction of the map.
  std::optional<double> displacement_m(double relative_friction) const;
  // Standard deviation of relative_friction at a displacement. For the load-sharing model it is what a length
  // u_s that differs by 30 % between fingers would cause; this share is assumed, because the model has no
  // data.
  double sd(double displacement_m) const;
  // The lowest friction of the map, and the displacement at which it is reached.
  double lowest_friction() const;
  double highest_displacement_m() const;
  // True for the illustrative load-sharing model, false for measured data.
  bool illustrative() const { return std::holds_alternative<Sharing>(model_); }

 private:
  struct Table {
    MonotoneCubic friction;
    MonotoneCubic sd;
  };
  // The load-sharing model and start values for solving it: the logarithm of the fraction of the load that
  // the contacts carry, at equal steps of displacement.
  struct Sharing {
    LoadSharing model;
    double highest_m;
    std::vector<double> ln_share;
  };
  std::variant<Sharing, Table> model_;
};

// Averages `values` over a fingertip of width `fingertip_m` centred at each x. The values are samples at
// ascending `x_m`, joined by straight lines. Near an end of the range, only the part of the fingertip inside
// the range counts.
std::vector<double> fingertip_average(std::span<const double> x_m, std::span<const double> values,
                                      double fingertip_m);

}  // namespace turnpoint::physics
