#pragma once
#include <array>

namespace turnpoint::core {

/// The verdict on whether the surface moved as planned during a stimulus, from what the pick-up on the
/// surface measured.
enum class Proof {
  /// nothing was measured, because the rig has no pick-up, or because the pick-up cannot measure these
  /// frequencies
  unproven,
  ok,       ///< the surface moved as planned
  flagged,  ///< the movement differed a little from the plan; the trial counts
  refused,  ///< the movement differed too much from the plan; the trial is void and presented again
  stopped,  ///< the movement is so wrong that the session stops until somebody has looked at the rig
  lost,     ///< the measurement has a gap during the stimulus; the trial is void
};

/// Why the verdict on a stimulus is not `ok`. The causes are in the order of importance: the first that
/// applies is reported.
enum class ProofCause {
  none,
  gap,        ///< captured frames were lost
  clipped,    ///< the captured signal reached full scale
  dead,       ///< the surface does not move
  frequency,  ///< the surface moves at another frequency
  half,       ///< one of two transducers, or of two supply rails, is missing: -6 dB
  late,       ///< the surface moved too late or too early
  offset,     ///< the surface stopped too late or too early, or its last ramp was cut short
  phase,      ///< phase differs from the calibration
  level,      ///< amplitude differs from the plan
  residual,   ///< the captured signal contains noise, or products of distortion
  noisy,      ///< the surface moves although it should be silent
};

inline constexpr std::array proofs{Proof::unproven, Proof::ok,      Proof::flagged,
                                   Proof::refused,  Proof::stopped, Proof::lost};
inline constexpr std::array proof_causes{ProofCause::none,     ProofCause::gap,       ProofCause::clipped,
                                         ProofCause::dead,     ProofCause::frequency, ProofCause::half,
                                         ProofCause::late,     ProofCause::offset,    ProofCause::phase,
                                         ProofCause::level,    ProofCause::residual,  ProofCause::noisy};

/// Return the words used in databases and exports: "unproven", "ok", "flagged", ...; "" for ProofCause::none.
const char* name(Proof proof);
const char* name(ProofCause cause);

/// Describes the cause in plain English, for messages: "the surface does not move".
const char* describe(ProofCause cause);

}  // namespace turnpoint::core
