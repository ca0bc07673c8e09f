#pragma once
#include <vector>

#include "station/core/records.hpp"
#include "station/sensing/friction_profile.hpp"

namespace turnpoint::session {

/// Collects the friction along the strip from the stored signals of trials. Trials with different boundaries
/// can be combined, because each position is a distance from the trial's own planned boundary.
class AlongStrip {
 public:
  /// Adds the strokes of a trial's last interval. A trial without a boundary adds nothing.
  void add(const core::TrialRow& row, const core::SignalRow& finger, double frames_per_s);

  /// Means and standard errors over strokes in bins of 2 mm, where there are 3 or more strokes.
  struct Curve {
    std::vector<double> from_boundary_mm, friction, se;
  };
  /// The curve of the strokes in one direction. 1: towards the narrow end; -1: towards the wide end.
  Curve curve(int direction) const;

 private:
  static constexpr double reach_mm = 80;
  sensing::FrictionProfile profile_{{-reach_mm, 2, static_cast<std::size_t>(reach_mm)}, {}};
};

}  // namespace turnpoint::session
