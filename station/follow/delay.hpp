#pragma once
#include <string>

namespace turnpoint::follow {

/// Everything that lies between the finger and what it feels. The same one for BridgeWindow and Follower.
struct Timing {
  int rate_Hz = 192000;
  int period_frames = 96;   ///< frames of one update, captured and played
  int buffer_periods = 2;   ///< periods that are already on their way to the converter
  int window_frames = 288;  ///< BridgeWindow: 1.5 ms
  double cells_s = 0;       ///< delay of the force cells' mechanics at low frequencies: 2 damping / w0
  double converter_s = 0;   ///< stated delay of the converters, from a played to a captured frame
  double film_s = 0;        ///< friction follows the amplitude by this much later
};

/// The timing of a device with this rate: a window of 1.5 ms and periods of 0.5 ms, rounded to a multiple of
/// 8 frames. Throws std::invalid_argument for a rate below 32 kHz.
Timing timing_of(int rate_Hz);

/// The largest delay from the finger's place to the amplitude, without the converters'.
inline constexpr double kMostDelay_s = 0.004;

/// The delay and its parts.
struct Delay {
  double window_s = 0;  ///< from the centre of the window to its end
  double buffer_s = 0;  ///< from the end of a captured period to the first frame that it changes
  double period_s = 0;  ///< to the last frame that it changes
  double cells_s = 0;
  double total_s = 0;  ///< the sum of these
  double converter_s = 0;
  double horizon_s = 0;  ///< how far the place of the first frame is predicted: also with converter and film
  bool refused() const { return !(total_s <= kMostDelay_s); }
};
Delay total_delay(const Timing& timing);

/// Says what the delay is made of and, if it is refused, that it is too long.
std::string sentence(const Delay& delay);

}  // namespace turnpoint::follow
