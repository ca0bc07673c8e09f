#pragma once
// Bounds the error of `modes` by solving a second time, at another resolution.
#include <optional>

#include "physics/centre_line.hpp"
#include "physics/edge.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

struct ModesBound {
  double shape = 0;       // error of |v| if the last maximum is set to one, relative to the largest value
  double drive = 0;       // error of |v| if v(0) is set to one, relative to the largest value
  double level_dB = 0;    // error of the ratio of |v| at the last maximum to |v(0)|
  double position_m = 0;  // error of the edge's position
};

// True if the error of `modes` can be bounded by comparing two solutions. It cannot for a clamped plate that
// is driven by a piston, because both solutions have much the same error at the corners.
bool modes_bound_applies(const Surface& surface);

// Which solution `modes` is compared with.
enum class Comparison {
  finer,   // takes four times as long as `modes`
  coarser  // takes half as long as `modes`; its bound is larger
};

// Returns several times the difference between `modes` and another solution. On random surfaces, the true
// error of |v| was at most 3.1 times the difference from a finer solution
// (tests/physics/modes_bound_test.cpp). Empty if only one of the two fields has a last maximum. `modes` is
// the solution at the default resolution, if it is known already.
std::optional<ModesBound> modes_bound(const Surface& surface, double frequency_Hz, const Edge& edge,
                                      Comparison comparison = Comparison::finer,
                                      const CentreLine* modes = nullptr);

}  // namespace turnpoint::physics
