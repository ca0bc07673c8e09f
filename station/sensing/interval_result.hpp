#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/core/proof.hpp"
#include "station/sensing/products.hpp"

namespace turnpoint::sensing {

/// Limits of one quantity: a deviation of this size or more flags the trial, refuses it, or stops the
/// session.
struct Limits {
  double flag = 0, refuse = 0, stop = 0;
};

/// Limits for judging the measured vibration of one interval (its proof), with the station's defaults. An
/// infinite limit is never exceeded.
struct ProofLimits {
  Limits level_dB{0.5, 1, 3};  ///< limits for the measured level relative to the plan, without a finger
  /// limits of the level if a finger loads the plate, or if it is not known whether one does
  Limits level_in_contact_dB{1.5, 3, 1e9};
  Limits phase_deg{10, 30, 1e9};  ///< limits for the measured phase minus the calibrated phase
  /// limits for the part of the vibration that the tones do not explain, and for each distortion product,
  /// relative to the planned vibration
  Limits residual_dB{-40, -30, -20};
  Limits onset_us{200, 1000,
                  1e9};  ///< limits for the error of the onset and of the offset (time at half level)
  /// limits for the vibration between trials, relative to the planned vibration
  Limits silence_dB{-70, -50, 1e9};
  /// for a burst that follows gains: limits of the envelope's error relative to what was commanded, and of
  /// its lag
  Limits envelope_error_dB{-20, -12, 1e9}, envelope_lag_us{300, 1000, 1e9};
  double clipped = 0.98;  ///< a trial is refused if a sample reaches this fraction of full scale
  double dead_dB = -40;   ///< a tone below this level, relative to the plan, counts as missing
  /// If all tones of a channel are between these levels, one of its two transducers is dead.
  double half_low_dB = -7.5, half_high_dB = -4.5;
  /// a pick-up whose response is this far below its best response cannot judge a tone
  double unseen_dB = -26;
};

/// What was measured for one tone, in one part of the burst in which nothing changes (a stretch).
struct ToneProof {
  int stretch = 0;  ///< number of changes of the burst before this stretch
  int tone = 0;     ///< index in the burst's tone set
  int drive_channel = 0;
  double frequency_Hz = 0;
  bool seen = false;          ///< true if a pick-up can judge this tone; otherwise the figures below are 0
  int pick_up = -1;           ///< the pick-up that measured this tone, counted from 0; -1 if none
  double ratio_dB = 0;        ///< measured level relative to the planned level, over the whole stretch
  double worst_ratio_dB = 0;  ///< ratio in the window of 0.2 s that deviates most; the limits apply to it
  double phase_error_deg = 0;
};

/// What was measured for one tone while it glided from one stretch to the next.
struct GlideToneProof {
  int change = 0;  ///< number of the change, from 1
  int tone = 0;    ///< index in the burst's tone set
  int drive_channel = 0;
  double from_Hz = 0, to_Hz = 0;
  bool seen = false;          ///< true if a pick-up can judge this tone in some part of the glide
  int pick_up = -1;           ///< the pick-up that measured worst_ratio_dB
  double worst_ratio_dB = 0;  ///< measured level relative to plan, in the window of 5 ms that deviates most
  double phase_error_deg = 0;
};

/// Limits for the loudest millisecond of what should not be there: 6 dB above those of the rms over 50 ms (in
/// a silence) or 0.2 s (in an interval). One click never stops a session.
inline Limits brief_limits(const ProofLimits& limits) {
  return {limits.residual_dB.flag + 6, limits.residual_dB.refuse + 6, 1e9};
}

/// The level that stands for nothing at all; measured levels are above it.
inline constexpr double kNothing_dB = -200;

/// Vibration between intervals, as measured by a pick-up.
struct SilenceResult {
  /// `unproven` if the burst has no steady tones to compare with, `lost` if fewer than 50 ms were captured
  core::Proof verdict = core::Proof::unproven;
  core::ProofCause cause = core::ProofCause::none;
  /// The strongest tone of any frequency in the loudest 50 ms, and the rms of everything in them. Both are
  /// relative to the burst, after the high-pass filter. The pick-up's own noise counts only for the rms.
  double level_dB = kNothing_dB, rms_dB = kNothing_dB;
  double brief_dB = kNothing_dB;  ///< rms of the loudest millisecond
};

/// What the pick-ups measured of one interval.
struct IntervalResult {
  /// `unproven` if there is a tone that no pick-up can judge, or if the interval is too short to measure.
  core::Proof verdict = core::Proof::unproven;
  core::ProofCause cause = core::ProofCause::none;
  std::vector<ToneProof> tones;
  std::vector<GlideToneProof> glides;
  int live_changes = 0;  ///< number of changes that were sent while the burst played
  double ratio_dB = 0;   ///< measured level of all judged tones together, relative to the planned level
  /// rms of everything that the tones do not explain, relative to the plan, in the worst window of 0.2 s. A
  /// high-pass filter (high_pass_gain()) comes first, so hum and friction noise hardly count.
  double residual_dB = kNothing_dB;
  double brief_dB =
      kNothing_dB;  ///< the same in the loudest millisecond of the window with the largest residual
  /// the strongest distortion product, in the window with the largest residual
  std::optional<Product> product;
  /// time at which the envelope reaches half its level, measured minus planned
  std::optional<double> onset_error_us;
  /// the same on the ramp at the end; empty if the burst was stopped or the last tones are too short
  std::optional<double> offset_error_us;
  /// Of a burst that follows gains (FollowProof): what the commanded envelope does not explain, relative to
  /// it; and its lag, empty if it is not known well enough.
  std::optional<double> envelope_error_dB, envelope_lag_us;
  std::optional<double> found_Hz;        ///< if the cause is `frequency`: the frequency of the vibration
  double largest_sample = 0;             ///< largest sample of the pick-ups, as a fraction of full scale
  std::int64_t lost_frames = 0;          ///< lost frames within the interval, rounded up to blocks of 1 ms
  std::optional<SilenceResult> silence;  ///< the silence before the interval, if it is the first of a trial
};

/// A verdict on one measured quantity, and the cause that the quantity points to.
struct Finding {
  core::ProofCause cause = core::ProofCause::none;
  core::Proof verdict = core::Proof::ok;
};

/// Returns the verdict on a deviation of this size.
core::Proof judged(double value, const Limits& limits);

/// Returns the most severe verdict (from best to worst: ok, flagged, unproven, lost, refused, stopped) and
/// its cause. If there are several causes, the first in the order of core::ProofCause is taken, because it
/// explains the others. A vibration that begins late, for example, also has wrong phases and a residual.
Finding concluded(const std::vector<Finding>& findings);

}  // namespace turnpoint::sensing
