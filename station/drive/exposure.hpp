#pragma once
#include <cstdint>
#include <deque>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace turnpoint::drive {

/// What a rig allows to reach a finger.
struct ExposureLimits {
  double displacement_m = 0;  ///< peak anywhere on the surface, tones summed
  double continuous_s = 30;   ///< without a rest of 0.5 s
  double duty = 0.8;          ///< of any 60 s
  double session_s = 3600;    ///< of one sitting, its interruptions included
};

/// A stimulus that was on the surface; seconds on a scale that goes on through restarts of the station, such
/// as the wall time that the database keeps.
struct Exposed {
  double start_s = 0;
  double end_s = 0;
};

/// A stimulus that a limit forbids, now or ever; the message names the limit, the value and what is allowed.
class LimitExceeded : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keeps account of what the finger got. Pure: no clock. After a restart it is given the last minute's
/// stimuli and the start of the session from the database, so that a crash does not reset a limit.
class Exposure {
 public:
  static constexpr double window_s = 60;
  static constexpr double rest_s = 0.5;

  /// Throws std::invalid_argument for limits that are not positive, or a duty above 1.
  Exposure(const ExposureLimits& limits, double session_start_s, const std::vector<Exposed>& history = {});

  /// Throws LimitExceeded where a stimulus of this displacement and length can never be presented.
  void check(double displacement_m, double length_s) const;

  /// The soonest time at or after `wanted_s` at which a stimulus of `length_s` keeps duty and continuous
  /// time. The interval between trials stretches to it, and says so. Throws LimitExceeded as above, and when
  /// the session's time would be over before the stimulus ends.
  double earliest_start_s(double wanted_s, double length_s) const;

  /// The same for several stimuli of one trial, given in order by their times from its start.
  double earliest_start_s(double wanted_s, std::span<const Exposed> trial) const;

  /// What was presented in the end. Stimuli must come in order.
  void add(const Exposed& exposed);

  double on_time_s(double from_s, double to_s) const;  ///< on the surface between two times

 private:
  bool fits(double start_s, double length_s) const;

  ExposureLimits limits_;
  double session_start_s_;
  std::deque<Exposed> recent_;
};

/// A measured sound pressure level at one metre or at the participant's ear, for full scale.
struct SoundLevel {
  double frequency_Hz = 0;
  double level_dB = 0;
};

/// For live sessions: a tone below 22.4 kHz needs a measured level at its frequency (between two measured
/// ones) that stays within 75 dB at its amplitude; from there to 25 kHz a measured level must stay within
/// 75 dB too, at and above 25 kHz within 110 dB. Returns what is wrong, or "". Occupational guidance; see the
/// rig's documentation.
std::string sound_problem(double frequency_Hz, double amplitude, const std::vector<SoundLevel>& measured);

}  // namespace turnpoint::drive
