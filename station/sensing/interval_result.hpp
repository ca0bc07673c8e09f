#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/sensing/products.hpp"
#include "station/terms/proof.hpp"

namespace turnpoint::sensing {

/// Limits of one quantity: a deviation of this size or more flags the trial, refuses it, or stops the
/// session.
struct Limits {
  double flag = 0, refuse = 0, stop = 0;
};

/// All limits of a proof, with the station's defaults. Infinity means never.
struct ProofLimits {
  Limits level_dB{0.5, 1, 3};  ///< measured against planned, without a finger
  Limits level_in_contact_dB{1.5, 3,
                             1e9};    ///< with a finger, or if that is not known; a finger loads the plate
  Limits phase_deg{10, 30, 1e9};      ///< against the calibration
  Limits residual_dB{-40, -30, -20};  ///< everything unexplained, and each product, re the plan
  Limits onset_us{200, 1000, 1e9};    ///< of the half level
  Limits silence_dB{-70, -50, 1e9};   ///< between trials, re the plan
  double clipped = 0.98;              ///< of the converter's full scale; any such sample refuses the trial
  double dead_dB = -40;               ///< below this a tone is missing
  double half_low_dB = -7.5, half_high_dB = -4.5;  ///< a channel in between has lost one of two transducers
  double unseen_dB = -26;  ///< a response this far below the pick-up's best one is not seen
};

/// What was measured of one tone in one steady stretch of its burst.
struct ToneProof {
  int stretch = 0;  ///< 0 before the first change of the burst, and so on
  int tone = 0;     ///< place in the burst's tone set
  int drive_channel = 0;
  double frequency_Hz = 0;
  bool seen = false;          ///< some pick-up can judge this tone; otherwise the figures below are 0
  int pick_up = -1;           ///< which one did, counted from 0
  double ratio_dB = 0;        ///< measured / planned, over the whole stretch
  double worst_ratio_dB = 0;  ///< the same in the window of 0.2 s that deviates most; this is judged
  double phase_error_deg = 0;
};

/// What the pick-ups measured of one interval.
struct IntervalResult {
  /// `unproven` if a tone is not seen by any pick-up, or if the interval is too short to measure
  terms::Proof verdict = terms::Proof::unproven;
  terms::ProofCause cause = terms::ProofCause::none;
  std::vector<ToneProof> tones;
  double ratio_dB = 0;  ///< measured / planned, all seen tones together
  /// rms of everything that the tones do not explain, re the plan, in the worst window of 0.2 s. It is
  /// measured behind a high-pass filter (high_pass_gain()), so hum and friction noise hardly count.
  double residual_dB = -200;
  std::optional<Product> product;        ///< the largest one, in the window with the largest residual
  std::optional<double> onset_error_us;  ///< half level against the plan, later is positive
  std::optional<double> found_Hz;        ///< if the cause is `frequency`: where the vibration is
  double largest_sample = 0;             ///< at the pick-ups, of full scale
  std::int64_t lost_frames = 0;          ///< within the interval, rounded up to blocks of 1 ms
};

/// One quantity that was judged.
struct Finding {
  terms::ProofCause cause = terms::ProofCause::none;
  terms::Proof verdict = terms::Proof::ok;
};

/// The verdict for the size of a deviation.
terms::Proof judged(double value, const Limits& limits);

/// The most severe verdict (from best to worst: ok, flagged, unproven, lost, refused, stopped) and its cause.
/// If there are several causes, it is the first in the order of terms::ProofCause, which explains the others:
/// a vibration that begins late, for example, also has wrong phases and a residual.
Finding concluded(const std::vector<Finding>& findings);

}  // namespace turnpoint::sensing
