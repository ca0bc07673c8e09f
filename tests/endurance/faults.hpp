#pragma once
#include <array>
#include <cstdint>
#include <random>

namespace endurance {

/// Faults that can happen to a station.
enum class Fault {
  amplifier_line,  ///< its fault line is active for some seconds
  stop_pressed,    ///< the stop is pressed, and released later
  converter_gone,  ///< the drive trips the amplifier; the device comes back later
  audio_silent,    ///< the audio thread does not report for longer than the guard allows
  underrun,        ///< frames are lost
  touch_gone,      ///< the touch panel is unplugged
  lines_gone,      ///< the GPIO chip of buttons and amplifier is unplugged, and comes back
  disarm,          ///< by the operator
  repeat,          ///< by the operator: void this trial
  pause,           ///< by the operator
  end_session,     ///< by the participant or the operator; the session is continued later
  clock_jump,      ///< somebody changes the wall clock by up to three days
  disk_full,       ///< after some more bytes, writes fail until there is space again
  kill,            ///< the process dies at a random moment
  kill_in_write,   ///< the process dies between two operations on its files
  power_cut,       ///< power fails at a random moment: any unsynced sector may be lost
  power_cut_in_write,
};
inline constexpr int kFaults = 17;
const char* name(Fault fault);

/// The seeded course of events: when the next fault comes, and which one. It is the same on every machine.
class Course {
 public:
  Course(std::uint64_t seed, double mean_interval_s) : random_(seed), mean_interval_s_(mean_interval_s) {}

  /// A value from low to high, both included.
  std::int64_t between(std::int64_t low, std::int64_t high);
  std::int64_t seconds(double low, double high);  ///< a duration, returned in ns
  std::int64_t until_next_ns();                   ///< between half and one and a half times the mean interval
  Fault next();

  std::array<int, kFaults> count{};  ///< number of faults that next() returned

 private:
  std::mt19937_64 random_;
  double mean_interval_s_;
};

}  // namespace endurance
