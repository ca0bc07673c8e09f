#pragma once

namespace turnpoint::scene {

/// Properties of a stimulus that a participant could use to answer instead of the property that the task asks
/// about. One number per cue.
struct Cues {
  double pitch_Hz = 0;              ///< lowest tone below 22.4 kHz; 0 if nothing is audible
  double loudness_dB = 0;           ///< drive of the audible tones, re 1 um at the edge; 0 if silent
  double wide_end_amplitude_m = 0;  ///< root of summed squares, averaged over the first 30 mm
  double stripe_pitch_m = 0;        ///< half the local wavelength of the strongest tone at the wide end
  double edge_width_m = 0;          ///< distance between 90 % and 10 % of the last maximum
  double strip_width_m = 0;         ///< width of the surface at the boundary
  double displacement_m = 0;        ///< at the last maximum
  double friction = 1;              ///< lowest value of the fingertip average
};

}  // namespace turnpoint::scene
