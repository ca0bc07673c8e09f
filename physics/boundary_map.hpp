#pragma once
// Converts a boundary to a frequency and back, for every definition of the boundary.
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

// The values, in addition to the surface, that determine an edge defined by friction.
struct FrictionContext {
  FrictionMap friction;
  double displacement_m = 1e-6;  // peak displacement at the last maximum of the vibration
  double fingertip_m = 10e-3;
};

struct MapOptions {
  Edge edge = Edge::turning();
  std::optional<Model> model;  // empty: the cheapest model whose error bound is within `tolerance_m`
  // largest error allowed; empty: the most exact model is used (`edge` if it has a closed form)
  std::optional<double> tolerance_m;
  std::optional<FrictionContext> friction;  // required if `edge` is defined by friction
  // The frequencies for which a table is made; if empty, all frequencies that the surface can present.
  struct Band {
    double low_Hz, high_Hz;
  };
  std::optional<Band> band = {};
};

// The map's answer to one query. If there is no such boundary, `boundary_m` and `frequency_Hz` are empty and
// `reason` says why; otherwise `reason` says why this model was used. `error_bound_m` bounds two errors: that
// of the model's equation, and that caused by higher modes from the drive edge. `uncertainty_m` is one
// standard deviation, from boundary_budget().
struct MapAnswer {
  std::optional<double> boundary_m;
  std::optional<double> frequency_Hz;
  Edge edge;
  Model model = Model::edge;
  double error_bound_m = 0;
  double uncertainty_m = 0;
  double m_per_Hz = 0;
  // How far the next better plate theory would move the boundary; not included in `error_bound_m`. See
  // plate_theory.hpp.
  std::optional<double> shear_shift_m;
  std::string reason;
  std::vector<Warning> warnings;
};

// The map between boundary and frequency for one surface and one edge, from the first transverse mode with
// loss. Making a map takes microseconds if the edge has a closed form. Otherwise it takes milliseconds,
// because a table is made and validated. boundary_m() and frequency_Hz() take well under a microsecond,
// allocate nothing and may be called from any thread.
class BoundaryMap {
 public:
  BoundaryMap(const Surface& surface, const MapOptions& options);
  ~BoundaryMap();
  BoundaryMap(BoundaryMap&&) noexcept;
  BoundaryMap& operator=(BoundaryMap&&) noexcept;

  // The boundary's position for a frequency, and the frequency for a position; empty if the surface cannot
  // present it.
  std::optional<double> boundary_m(double frequency_Hz) const noexcept;
  std::optional<double> frequency_Hz(double boundary_m) const noexcept;

  // The same look-ups, with error bounds, reason and warnings.
  MapAnswer at_frequency(double frequency_Hz) const;
  MapAnswer at_boundary(double boundary_m) const;

  Model model() const noexcept;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

// Finds the frequency that puts the edge at a position, without making a table. The result is accurate to a
// nanometre for the first transverse mode or, if options.model is `modes`, to 0.1 um for the two-dimensional
// field. The search needs only a few solutions, so it is cheaper than a map that is used once. It is cheaper
// still if `near_Hz`, the frequency according to the first mode, is given. Returns empty if the search fails;
// a map may find a frequency nevertheless.
std::optional<double> solve_frequency_Hz(const Surface& surface, const MapOptions& options, double boundary_m,
                                         std::optional<double> near_Hz = {});

// The positions between which an edge can lie. Takes a tenth of the time that a map takes. Throws Refused if
// there is no such edge at the frequencies of `options`.
struct Reach {
  double first_m, last_m;
  bool contains(double x_m) const { return first_m <= x_m && x_m <= last_m; }
};
Reach boundary_reach_m(const Surface& surface, const MapOptions& options);

// The answer of a map to one boundary, by a map of the frequencies around it only.
MapAnswer answer_at_boundary(const Surface& surface, const MapOptions& options, double boundary_m);

}  // namespace turnpoint::physics
