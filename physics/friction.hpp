#pragma once
// Converts vibration amplitude to relative friction, and back.
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "physics/monotone_cubic.hpp"

namespace turnpoint::physics {

// Mean overpressure in a squeeze film between parallel plates at infinite squeeze number, in units of the
// ambient pressure p0, for excursion e = amplitude / gap in [0, 1): sqrt((1 + 3 e^2/2)/(1 - e^2)) - 1
// (Langlois 1962; Salbu 1964).
double squeeze_film_overpressure(double excursion);

// A model in which the fingertip shares its load between skin contacts and the air film (after Wiertlewski,
// Friesen & Colgate, PNAS 2016): p = P* exp(-u/u_s) + p0 overpressure(a/u); relative friction is P*
// exp(-u/u_s)/p, limited below by `floor`. An illustrative curve; live sessions need a measured table.
struct LoadSharing {
  double pressure_Pa = 5000;     // pressure of the finger on the surface
  double floor = 0.1;            // friction that remains at any amplitude; for real skin 0.1 to 0.2
  double decay_length_m = 2e-6;  // the length u_s over which the contacts' share decays with the gap
  double rest_gap_m = 4e-6;      // gap without vibration, under `pressure_Pa`
  double ambient_Pa = 101325;    // p0
};

// One measured point. A table begins at (0, 1), and its relative_friction falls strictly with displacement.
struct FrictionPoint {
  double displacement_m = 0;
  double relative_friction = 1;
  double sd = 0;  // standard deviation of relative_friction
};

// A monotone map from peak displacement to friction relative to the surface at rest. The load-sharing model
// is solved to rounding; its floor f enters as mu^4 = f^4 + (1 - f^4) mu_sharing^4, which stays strictly
// monotone and hardly changes friction above three times the floor. Measured tables are joined by monotone
// cubics and keep their last value beyond the last point. A value type; const functions are thread-safe.
class FrictionMap {
 public:
  FrictionMap() : FrictionMap(LoadSharing{}) {}
  explicit FrictionMap(const LoadSharing& model);
  explicit FrictionMap(std::vector<FrictionPoint> table);  // throws std::invalid_argument

  // Relative friction in (0, 1] for a peak displacement >= 0.
  double relative_friction(double displacement_m) const;
  // The displacement for a relative friction: 0 for friction 1, empty below the lowest friction of the map.
  std::optional<double> displacement_m(double relative_friction) const;
  // Standard deviation of relative_friction at a displacement; 0 for a model without data.
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
  // The load-sharing model with start values for its solution: ln of the contacts' share at equal steps of
  // displacement.
  struct Sharing {
    LoadSharing model;
    double highest_m;
    std::vector<double> ln_share;
  };
  std::variant<Sharing, Table> model_;
};

// Mean of `values` (sampled at ascending `x_m` and joined linearly) over a fingertip of width `fingertip_m`
// centred at each x. Near an end of the range, the mean is over the part of the fingertip inside it.
std::vector<double> fingertip_average(std::span<const double> x_m, std::span<const double> values,
                                      double fingertip_m);

}  // namespace turnpoint::physics
