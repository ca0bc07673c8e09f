#pragma once
#include <cstdint>
#include <deque>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace turnpoint::limits {

/// The largest vibration that a rig may deliver to a finger.
struct ExposureLimits {
  double displacement_m = 0;  ///< peak anywhere on the surface, all tones added
  double continuous_s = 30;   ///< longest vibration without a rest of 0.5 s
  double duty = 0.8;          ///< fraction of any 60 s
  double session_s = 3600;    ///< one period of exposure, including its interruptions
};

/// A presented stimulus. Its times (seconds) must be on a scale that continues when the station restarts,
/// such as the wall time in the database.
struct Exposed {
  double start_s = 0;
  double end_s = 0;
};

/// A limit forbids this stimulus, either now or always. The message names the limit, the value and what is
/// allowed.
class LimitExceeded : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keeps account of the finger's exposure to vibration. Pure: no clock. After a restart, pass the last
/// minute's stimuli and the session's start from the database, so that a crash does not reset a limit.
class Exposure {
 public:
  static constexpr double window_s = 60;
  static constexpr double rest_s = 0.5;

  /// Throws std::invalid_argument for limits that are not positive, or a duty above 1.
  Exposure(const ExposureLimits& limits, double session_start_s, const std::vector<Exposed>& history = {});

  /// Throws LimitExceeded if a stimulus of this displacement and length can never be presented.
  void check(double displacement_m, double length_s) const;

  /// The earliest time at or after `wanted_s` at which a stimulus of `length_s` meets the limits of duty
  /// cycle and continuous vibration. The pause between trials is extended accordingly and reported. Throws
  /// LimitExceeded if the stimulus can never be presented, or if the session's time ends before the stimulus
  /// does.
  double earliest_start_s(double wanted_s, double length_s) const;

  /// The same for all stimuli of one trial, given in order with times from its start.
  double earliest_start_s(double wanted_s, std::span<const Exposed> trial) const;

  /// Records what was actually presented. Add stimuli in order.
  void add(const Exposed& exposed);

  double on_time_s(double from_s, double to_s) const;  ///< total stimulation between two times

 private:
  bool fits(double start_s, double length_s) const;

  ExposureLimits limits_;
  double session_start_s_;
  std::deque<Exposed> recent_;
};

/// A sound pressure level measured at one metre or at the participant's ear, for a drive at full scale.
struct SoundLevel {
  double frequency_Hz = 0;
  double level_dB = 0;
};

/// True if a level was measured at this frequency, or at one below and one above it.
bool sound_measured(double frequency_Hz, const std::vector<SoundLevel>& measured);

/// For live sessions. A tone below 22.4 kHz needs a measured level (see sound_measured()). A measured level,
/// at the tone's amplitude, must stay within terms::allowed_sound_dB(). Returns the problem, or "" if there
/// is none.
std::string sound_problem(double frequency_Hz, double amplitude, const std::vector<SoundLevel>& measured);

}  // namespace turnpoint::limits
