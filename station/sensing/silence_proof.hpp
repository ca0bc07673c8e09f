#pragma once
#include <cstdint>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/interval_proof.hpp"

namespace turnpoint::sensing {

/// What the pick-ups measured between intervals.
struct SilenceResult {
  terms::Proof verdict = terms::Proof::unproven;  ///< unproven if less than 50 ms were captured
  terms::ProofCause cause = terms::ProofCause::none;
  double level_dB =
      -200;  ///< rms of the loudest 50 ms, re the plan, behind the filter against low frequencies
};

/// Measures whether the surface rests between two intervals. Allocates only in its constructor. For an
/// ordinary thread.
class SilenceProof {
 public:
  /// The plan's burst is what the silence is compared with: that of the interval before or after. Silence is
  /// measured by the pick-up that sees most of it.
  explicit SilenceProof(const IntervalPlan& plan);

  /// Takes captured frames, all of which should be silent. Allow for the delay of the loop and a few
  /// milliseconds in which the plate rings after a burst.
  void push(const CaptureBlock& block);

  SilenceResult result() const noexcept;

 private:
  void take(const AlignedBlock& block) noexcept;

  Limits limits_;
  double planned_ = 0;  ///< mean square
  AlignedBlocks blocks_;
  int window_blocks_;
  int blocks_taken_ = 0;  ///< in the current window
  bool measured_ = false;
  double energy_ = 0, largest_ = 0;
};

}  // namespace turnpoint::sensing
