#pragma once
// Boundary <-> frequency, for every definition of the boundary.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/edge.hpp"
#include "physics/friction.hpp"
#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/warning.hpp"

namespace turnpoint::physics {

// What a friction edge requires in addition to the surface.
struct FrictionContext {
  FrictionMap friction;
  double displacement_m = 1e-6;  // peak amplitude at the last maximum
  double fingertip_m = 10e-3;
};

struct MapOptions {
  Edge edge = Edge::turning();
  std::optional<Model> model;               // none: cheapest whose bound is inside `tolerance_m`
  std::optional<double> tolerance_m;        // none: the most exact position there is (`edge` where closed)
  std::optional<FrictionContext> friction;  // required for a friction edge
  // Frequencies for which a table is made. Empty: all that the surface can present.
  struct Band {
    double low_Hz, high_Hz;
  };
  std::optional<Band> band = {};
};

// One answer; the optionals are none when there is no such boundary, and `reason` says why (otherwise why
// this model). `error_bound_m`: what the drive edge's higher modes and the model's equation may move;
// `uncertainty_m`: one standard deviation from the surface's `sd`.
struct MapAnswer {
  std::optional<double> boundary_m;
  std::optional<double> frequency_Hz;
  Edge edge;
  Model model = Model::edge;
  double error_bound_m = 0;
  double uncertainty_m = 0;
  double m_per_Hz = 0;
  // How far the next better plate theory would move it, not part of `error_bound_m`; see plate_theory.hpp.
  std::optional<double> shear_shift_m;
  std::string reason;
  std::vector<Warning> warnings;
};

// The map of one surface and one edge, by its first transverse mode with loss. Building it takes microseconds
// where it is closed, else milliseconds (a table is made and validated); the two look-ups take well under a
// microsecond, allocate nothing and may be called from any thread.
class BoundaryMap {
 public:
  BoundaryMap(const Surface& surface, const MapOptions& options);
  ~BoundaryMap();
  BoundaryMap(BoundaryMap&&) noexcept;
  BoundaryMap& operator=(BoundaryMap&&) noexcept;

  // Position for a frequency, and frequency for a position; empty outside what the surface can present.
  std::optional<double> boundary_m(double frequency_Hz) const noexcept;
  std::optional<double> frequency_Hz(double boundary_m) const noexcept;

  // The same with bounds, reason and warnings.
  MapAnswer at_frequency(double frequency_Hz) const;
  MapAnswer at_boundary(double boundary_m) const;

  Model model() const noexcept;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

// The frequency that puts the edge at a position, without a table: to a nanometre by the first transverse
// mode, or, if options.model is `modes`, to 0.1 um by the two-dimensional field. It needs only a few
// solutions, which is cheaper than a map that would be used once; fewer from `near_Hz`, the frequency of the
// first mode. Empty if the search finds none; a map may still find one.
std::optional<double> solve_frequency_Hz(const Surface& surface, const MapOptions& options, double boundary_m,
                                         std::optional<double> near_Hz = {});

}  // namespace turnpoint::physics
