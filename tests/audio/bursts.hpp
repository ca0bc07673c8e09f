#pragma once
#include "station/audio/burst.hpp"

namespace turnpoint::audio {

/// Makes a burst of half a second at 192 kHz: one tone on channel 0 with ramps of 50 ms.
inline Burst one_tone(double frequency_Hz, double amplitude, double phase_rad = 0) {
  Burst burst;
  burst.length_frames = 96000;
  burst.tones.count = 1;
  burst.tones.tones[0] = {frequency_Hz, amplitude, phase_rad, 0};
  return burst;
}

}  // namespace turnpoint::audio
