#pragma once
#include <array>

namespace turnpoint::terms {

/// What the pick-up on the surface says about a stimulus.
enum class Proof {
  unproven,  ///< nothing was measured, because the rig has no pick-up or it cannot see these frequencies
  ok,        ///< the surface moved as planned
  flagged,   ///< it differed a little from the plan; the trial counts
  refused,   ///< it differed too much; the trial is void and presented again
  stopped,   ///< so much is wrong that the session stops until somebody has looked
  lost,      ///< the measurement has a gap during the stimulus; the trial is void
};

/// Why a stimulus is not proven to be as planned. The order is that of importance: the first that applies is
/// reported.
enum class ProofCause {
  none,
  gap,        ///< captured frames were lost
  clipped,    ///< the captured signal reached full scale
  dead,       ///< the surface does not move
  frequency,  ///< it moves at another frequency
  half,       ///< one of two transducers, or of two supply rails, is missing: -6 dB
  late,       ///< it moved too late or too early
  phase,      ///< phase differs from the calibration
  level,      ///< amplitude differs from the plan
  residual,   ///< noise, or products of distortion
  noisy,      ///< the surface moves although it should be silent
};

inline constexpr std::array proofs{Proof::unproven, Proof::ok,      Proof::flagged,
                                   Proof::refused,  Proof::stopped, Proof::lost};
inline constexpr std::array proof_causes{ProofCause::none,     ProofCause::gap,       ProofCause::clipped,
                                         ProofCause::dead,     ProofCause::frequency, ProofCause::half,
                                         ProofCause::late,     ProofCause::phase,     ProofCause::level,
                                         ProofCause::residual, ProofCause::noisy};

/// Return the words used in databases and exports: "unproven", "ok", "flagged", ...; for `none` "".
const char* name(Proof proof);
const char* name(ProofCause cause);

/// Describes the cause in plain English, for messages: "the surface does not move".
const char* describe(ProofCause cause);

}  // namespace turnpoint::terms
