#pragma once
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "station/audio/burst.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// What a pick-up reads of the tone that is playing, as the amplitude over 10 ms.
struct ToneReading {
  int channel = 0;                        ///< captured channel of the pick-up
  double amplitude = 0;                   ///< 1 is full scale of the capture
  std::optional<double> displacement_um;  ///< empty unless the scale of the pick-up has been calibrated
};
/// Receives the readings of all pick-ups, five times a second. Called on another thread; must return at once.
using OnToneReadings = std::function<void(const std::vector<ToneReading>&)>;

/// True if the rig has pick-ups that can be read while a tone of its own plays.
bool reads_tones(const rig::Rig& rig);

/// Plays one tone on the rig at an operator's request, as play_on_rig() does, and reads the pick-ups
/// meanwhile. A simulated tone takes as long as a real one. Without pick-ups (see reads_tones) it only plays.
/// Throws the errors of play_on_rig() and of CaptureThread.
void play_and_read(const rig::Rig& rig, const audio::Burst& tone, const std::stop_token& stop,
                   const OnToneReadings& on_readings);

}  // namespace turnpoint::maintenance
