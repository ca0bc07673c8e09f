#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "physics/surface.hpp"
#include "station/sensing/phase_drift.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::session {

/// Follows what warmth does to the surface during a session: the temperatures of plate and frame, and the
/// drift of the resonances. Used on the session thread.
class Drift {
 public:
  /// Finds the thermometers that the rig names. Throws the errors of system::find_thermometer().
  Drift(const Setup& setup, Stage& stage, store::SessionLog& log);

  /// Logs the temperatures before a trial. When a thermometer first differs by 3 K from its first reading,
  /// the change is flagged; its later changes are not.
  void log_temperature(int trial_index);

  /// Takes the measured phases of an interval's tones.
  void follow(const sensing::IntervalResult& measured);

  /// If the boundaries have moved by 0.2 mm or more since the last correction, logs that, and returns the
  /// fraction by which the frequencies of the following trials must be raised. Otherwise returns nothing.
  std::optional<double> correction(int trial_index);

 private:
  const Setup& setup_;
  Stage& stage_;
  store::SessionLog& log_;
  /// files of the two thermometers, on plate and frame; empty if the rig has none
  std::vector<std::string> thermometers_;
  std::array<std::optional<double>, 2> first_C_;
  std::array<bool, 2> warm_{};
  std::optional<sensing::DriftTracker> tracker_;  ///< empty without pick-ups
  std::optional<sensing::PhaseDrift> newest_;     ///< the newest drift that was found in the running trial
  double applied_ = 0;
};

/// Returns how far the place where a tone's vibration ends moves (in m, towards the narrow edge) if all
/// resonance frequencies of the surface rise by the fraction `share`.
double boundary_shift_m(const physics::Surface& surface, double frequency_Hz, double share);

}  // namespace turnpoint::session
