#pragma once
// From vibration amplitude to relative friction, and back.
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "physics/monotone_cubic.hpp"

namespace turnpoint::physics {

// Mean film force of a squeeze film between parallel plates at infinite squeeze number, in units of p0 A, for
// excursion = amplitude / gap in [0, 1): sqrt((1 + 3 e^2/2)/(1 - e^2)) - 1 (Langlois 1962; Salbu 1964).
double squeeze_film_overpressure(double excursion);

// The fingertip shares its load between skin contacts and the film (after Wiertlewski, Friesen & Colgate,
// PNAS 2016): p = P* exp(-u/u_s) + p0 overpressure(a/u), relative friction = P* exp(-u/u_s)/p, held above
// `floor`. An illustrative curve; live sessions need a measured table.
struct LoadSharing {
  double pressure_Pa = 5000;     // pressure of the finger
  double floor = 0.1;            // real skin keeps some friction, .1 to .2
  double decay_length_m = 2e-6;  // u_s, of the contact's share
  double rest_gap_m = 4e-6;      // gap at rest under `pressure_Pa`
  double ambient_Pa = 101325;    // p0
};

// One measured point; relative_friction falls strictly with displacement, starting at (0, 1).
struct FrictionPoint {
  double displacement_m = 0;
  double relative_friction = 1;
  double sd = 0;  // standard deviation of relative_friction
};

// A monotone map from peak displacement to friction relative to the surface at rest. Load sharing is solved
// to rounding; its floor f enters as mu^4 = f^4 + (1 - f^4) mu_sharing^4, which is strictly monotone and
// leaves friction above three floors as it is. Measured tables are joined by monotone cubics and hold their
// last value beyond the last point. Value type; const functions are thread-safe.
class FrictionMap {
 public:
  FrictionMap() : FrictionMap(LoadSharing{}) {}
  explicit FrictionMap(const LoadSharing& model);
  explicit FrictionMap(std::vector<FrictionPoint> table);  // throws std::invalid_argument

  // Relative friction in (0, 1] for a peak displacement >= 0.
  double relative_friction(double displacement_m) const;
  // Inverse; empty for friction below what the map reaches. friction = 1 gives 0.
  std::optional<double> displacement_m(double relative_friction) const;
  // Standard deviation of relative_friction (0 for a model without data).
  double sd(double displacement_m) const;
  // Lowest friction of the map and where it is reached.
  double lowest_friction() const;
  double highest_displacement_m() const;
  // Whether it is the illustrative curve rather than measured data.
  bool illustrative() const { return std::holds_alternative<Sharing>(model_); }

 private:
  struct Table {
    MonotoneCubic friction;
    MonotoneCubic sd;
  };
  // Load sharing with the start values of its solution: ln of the contacts' share at equal steps of
  // displacement.
  struct Sharing {
    LoadSharing model;
    double highest_m;
    std::vector<double> ln_share;
  };
  std::variant<Sharing, Table> model_;
};

// Mean of `values` (sampled at ascending `x_m`, joined linearly) over a fingertip of width `fingertip_m`
// centred at each x; near an end the window is cut, not shifted.
std::vector<double> fingertip_average(std::span<const double> x_m, std::span<const double> values,
                                      double fingertip_m);

}  // namespace turnpoint::physics
