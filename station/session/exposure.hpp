#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/core/parts.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::session {

/// The largest vibration that a rig may deliver to a finger.
struct ExposureLimits {
  double displacement_m = 0;  ///< largest peak displacement anywhere on the surface, with all tones added
  double continuous_s = 30;   ///< longest vibration without a pause of 0.5 s
  double duty = 0.8;          ///< largest fraction of any 60 s in which the surface may vibrate
  double session_s = 3600;    ///< longest period of exposure, pauses included (see finger_account.hpp)
};

/// The start and end of a stimulus that was presented, in seconds. Use a clock that does not restart with the
/// station, such as the wall time in the database.
struct Exposed {
  double start_s = 0;
  double end_s = 0;
};

/// Thrown if a limit forbids a stimulus, either now or always. The message names the limit, the value and
/// what is allowed.
class LimitExceeded : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keeps account of how long the finger was exposed to vibration. Pure: it has no clock. After a restart,
/// pass the last minute's stimuli and the start of the period of exposure from the database, so that a crash
/// does not reset a limit.
class Exposure {
 public:
  static constexpr double window_s = core::kExposureWindow_s;
  static constexpr double rest_s = core::kRest_s;

  /// Throws std::invalid_argument for limits that are not positive, or a duty above 1.
  Exposure(const ExposureLimits& limits, double session_start_s, const std::vector<Exposed>& history = {});

  /// Throws LimitExceeded if a stimulus of this displacement and length can never be presented.
  void check(double displacement_m, double length_s) const;

  /// Returns the earliest time, at or after `wanted_s`, at which a stimulus of `length_s` keeps within the
  /// limits of duty cycle and continuous vibration. Throws LimitExceeded if the stimulus can never be
  /// presented, or if the period of exposure would end before the stimulus does.
  double earliest_start_s(double wanted_s, double length_s) const;

  /// Returns the earliest time at which a whole trial may begin. `trial` lists the trial's stimuli in order,
  /// with times from the start of the trial.
  double earliest_start_s(double wanted_s, std::span<const Exposed> trial) const;

  /// Records a stimulus that was presented. Add stimuli in order of time.
  void add(const Exposed& exposed);

  double on_time_s(double from_s, double to_s) const;  ///< duration of vibration between the two times

 private:
  bool fits(double start_s, double length_s) const;

  ExposureLimits limits_;
  double session_start_s_;
  std::deque<Exposed> recent_;
};

/// A sound pressure level that was measured with the drive at full scale, at one metre or at the
/// participant's ear.
struct SoundLevel {
  double frequency_Hz = 0;
  double level_dB = 0;
};

/// True if a level was measured at this frequency, or at both a lower and a higher frequency.
bool sound_measured(double frequency_Hz, const std::vector<SoundLevel>& measured);

/// Checks the sound of a tone in a live session. A tone below 22.4 kHz needs a measured level (see
/// sound_measured()). The measured level, reduced to the tone's amplitude, must not exceed
/// core::allowed_sound_dB(). Returns the problem; empty if there is none.
std::optional<core::Phrase> sound_problem(double frequency_Hz, double amplitude,
                                          const std::vector<SoundLevel>& measured);

}  // namespace turnpoint::session
