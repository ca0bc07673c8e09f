#pragma once
// Bounds the error of `modes` by solving a second time, at another resolution.
#include <optional>

#include "physics/centre_line.hpp"
#include "physics/edge.hpp"
#include "physics/mode_bound.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

struct ModesBound {
  double shape = 0;       // error of |v| if the last maximum is set to one, relative to the largest value
  double drive = 0;       // error of |v| if v(0) is set to one, relative to the largest value
  double level_dB = 0;    // error of the ratio of |v| at the last maximum to |v(0)|
  double position_m = 0;  // error of the edge's position
  bool jump = false;      // true if the two solutions have different last maxima, see LineDifference
};

// The error that is assumed of a solution of `modes` before it is compared with another, for the default
// resolution and for the coarsest one: of |v| relative to the last maximum, and of the wave at the drive
// edge, relative to the envelope of the standing wave there. `first` is the bound of the first mode on the
// same surface, which says how steep the sides are and how much a higher mode may resonate. Where the
// coarsest solution differs from `mode`, a quarter of the difference may add to its error.
struct AssumedError {
  double shape, drive;
};
enum class Resolution { usual, coarsest };
AssumedError assumed_error(const Surface& surface, double frequency_Hz, const ModeBound& first,
                           Resolution resolution);

// True if the error of `modes` can be bounded by comparing two solutions. It cannot for a clamped plate that
// is driven by a piston, because both solutions have much the same error at the corners.
bool modes_bound_applies(const Surface& surface);

// Which solution `modes` is compared with.
enum class Comparison {
  finer,    // takes four times as long as `modes`, on a thick plate seven times
  coarser,  // takes half as long as `modes`, with fewer functions across the strip; its bound is larger
  coarsest  // takes a tenth as long, and is mostly a hundred times as wrong as `modes`
};

// Solves for `modes` once more, at the resolution that it is compared with. Throws std::domain_error where
// `modes` does not apply.
std::unique_ptr<CentreLine> make_compared_line(const Surface& surface, double frequency_Hz,
                                               Comparison comparison);

// How far two solutions are apart, in the quantities of ModesBound, and near the last maximum of the first.
struct LineDifference {
  double shape = 0, drive = 0;            // of |v|, relative to the largest value
  double near_shape = 0, near_drive = 0;  // the same near the last maximum; relative to that maximum
  double ln_gain = 0;                     // of the logarithm of |v| at the last maximum over |v(0)|
  double edge_m = 0;  // of the edge's position; the surface's length if only one of them has the edge
  std::optional<double> peak_m, at_m;  // last maximum and edge of the first
  // True if the last maxima or the edges are farther apart than half of the cut-off half-width, or only one
  // of the two has the edge. They are then not the same, and the difference is no measure of a small error.
  bool jump = false;
  // how far |v| of `modes` falls from its last maximum towards the drive edge before it rises again, relative
  // to that maximum
  double fall = 0;
};

// Compares `line`, whose logarithm of |v(0)| is `ln_drive`, with a solution of `modes`. Empty if only one of
// the two fields has a last maximum.
std::optional<LineDifference> line_difference(const Surface& surface, double frequency_Hz, const Edge& edge,
                                              const CentreLine& line, double ln_drive,
                                              const CentreLine& modes);

// Returns several times the difference between a solution of `modes` at the default resolution and one at
// another. On random surfaces, the true error of |v| was at most 3.1 times the difference from a finer
// solution (tests/physics/modes_bound_test.cpp). Empty if only one of the two fields has a last maximum.
std::optional<ModesBound> modes_bound(const Surface& surface, double frequency_Hz, const Edge& edge,
                                      Comparison comparison, const CentreLine& modes,
                                      const CentreLine& compared);

}  // namespace turnpoint::physics
