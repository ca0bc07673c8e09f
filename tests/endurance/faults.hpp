#pragma once
#include <array>
#include <cstdint>
#include <random>

namespace endurance {

/// What happens to a station on a bad day.
enum class Fault {
  amplifier_line,  ///< its fault line is active for some seconds
  stop_pressed,    ///< the stop is pressed, and released later
  converter_gone,  ///< the drive trips the amplifier; the device comes back
  audio_silent,    ///< the audio thread gives no sign for longer than the guard allows
  underrun,        ///< frames are lost
  touch_gone,      ///< the touch panel is unplugged
  lines_gone,      ///< the GPIO chip of buttons and amplifier is unplugged, and comes back
  disarm,          ///< operator
  repeat,          ///< operator: void this trial
  pause,           ///< operator
  end_session,     ///< participant or operator; gone on with later
  clock_jump,      ///< somebody sets the wall clock, by up to three days
  disk_full,       ///< some more bytes can be written, then none until space is made
  kill,            ///< the process dies at a random moment
  kill_in_write,   ///< the process dies between two operations on its files
  power_cut,       ///< power fails at a random moment: of what was not synced, any sector or none stays
  power_cut_in_write,
};
inline constexpr int kFaults = 17;
const char* name(Fault fault);

/// The seeded course of events: when the next fault comes and which. Equal on every machine.
class Course {
 public:
  Course(std::uint64_t seed, double mean_interval_s) : random_(seed), mean_interval_s_(mean_interval_s) {}

  /// In low ... high.
  std::int64_t between(std::int64_t low, std::int64_t high);
  std::int64_t seconds(double low, double high);  ///< as ns
  std::int64_t until_next_ns();                   ///< between half and three halves of the mean interval
  Fault next();

  std::array<int, kFaults> count{};  ///< of faults given by next()

 private:
  std::mt19937_64 random_;
  double mean_interval_s_;
};

}  // namespace endurance
