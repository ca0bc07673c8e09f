#pragma once
#include <array>
#include <cstdint>
#include <random>

namespace endurance {

/// Faults and operator's actions that can happen to a station.
enum class Fault {
  amplifier_line,  ///< the amplifier's fault line is active for some seconds
  stop_pressed,    ///< the emergency stop is pressed, and released later
  converter_gone,  ///< the sound device fails and trips the amplifier; it comes back later
  audio_silent,    ///< the audio thread does not report for longer than the guard allows
  underrun,        ///< the sound device loses frames
  touch_gone,      ///< the touch panel is unplugged
  lines_gone,      ///< the GPIO chip of buttons and amplifier is unplugged, and comes back
  disarm,          ///< the operator disarms
  repeat,          ///< the operator declares this trial void, so that it is repeated
  pause,           ///< the operator pauses the session
  end_session,     ///< participant or operator ends the session, which is continued later
  clock_jump,      ///< somebody changes the wall clock by up to three days
  disk_full,       ///< after some more bytes, writes fail until there is space again
  kill,            ///< the process dies at a random moment
  kill_in_write,   ///< the process dies between two operations on its files
  power_cut,       ///< power fails at a random moment: any unsynced sector may be lost
  power_cut_in_write,
};
inline constexpr int kFaults = 17;
const char* name(Fault fault);

/// The sequence of faults in a run, determined by a seed: when the next fault comes, and which one. It is the
/// same on every machine.
class Course {
 public:
  Course(std::uint64_t seed, double mean_interval_s) : random_(seed), mean_interval_s_(mean_interval_s) {}

  /// A random value from `low` to `high`, both included.
  std::int64_t between(std::int64_t low, std::int64_t high);
  std::int64_t seconds(double low, double high);  ///< a random duration, returned in ns
  /// Random time until the next fault: 0.5 to 1.5 times the mean interval.
  std::int64_t until_next_ns();
  Fault next();

  std::array<int, kFaults> count{};  ///< how often next() has returned each fault

 private:
  std::mt19937_64 random_;
  double mean_interval_s_;
};

}  // namespace endurance
