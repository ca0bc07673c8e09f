#pragma once

namespace turnpoint::scene {

/// What a participant could judge by, other than what the task asks: one number a cue.
struct Cues {
  double pitch_Hz = 0;              ///< lowest tone below 22.4 kHz; 0: nothing audible
  double loudness_dB = 0;           ///< of the audible tones' drive, re 1 um at the edge; 0 when silent
  double wide_end_amplitude_m = 0;  ///< root of summed squares, mean over the first 30 mm
  double stripe_pitch_m = 0;        ///< half the local wavelength at the wide end, strongest tone
  double edge_width_m = 0;          ///< from 90 % to 10 % of the last maximum
  double strip_width_m = 0;         ///< of the surface at the boundary
  double displacement_m = 0;        ///< at the last maximum
  double friction = 1;              ///< lowest, fingertip average
};

}  // namespace turnpoint::scene
