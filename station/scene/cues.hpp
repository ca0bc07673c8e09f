#pragma once

namespace turnpoint::scene {

/// Properties of a stimulus that could give the right answer away. A participant could use them instead of
/// the property that the task asks about.
struct Cues {
  double pitch_Hz = 0;  ///< frequency of the lowest tone below 22.4 kHz; 0 if no tone is audible
  /// amplitude of the audible tones at the drive edge, in dB re 1 um; 0 if there are none
  double loudness_dB = 0;
  /// displacement of all tones (root of summed squares), averaged over the 30 mm next to the drive edge
  double wide_end_amplitude_m = 0;
  /// half the local wavelength of the strongest tone at the wide end of the surface
  double stripe_pitch_m = 0;
  /// distance over which the displacement falls from 90 % to 10 % of its last maximum
  double edge_width_m = 0;
  double strip_width_m = 0;   ///< width of the surface at the boundary
  double displacement_m = 0;  ///< displacement at the last maximum of the vibration along the surface
  double friction = 1;        ///< lowest friction anywhere on the surface, averaged over the fingertip
};

}  // namespace turnpoint::scene
