#pragma once
#include <cstdint>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/interval_proof.hpp"

namespace turnpoint::sensing {

/// Measures whether the surface is at rest between two intervals. Taking frames allocates nothing. For an
/// ordinary thread.
class SilenceProof {
 public:
  /// The silence is compared with the burst in `plan`, so pass the plan of the interval before or after the
  /// silence. The silence is measured with the pick-up that captures this burst most strongly.
  explicit SilenceProof(const IntervalPlan& plan);

  /// Takes captured frames, all of which should be silent. Do not pass the frames just after a burst, which
  /// still contain its end because of the loop delay, and the ringing of the plate for a few milliseconds.
  void push(const CaptureBlock& block);

  /// Takes about 1 ms.
  SilenceResult result() const;

 private:
  void take(const AlignedBlock& block) noexcept;

  int rate_Hz_;
  Limits tone_limits_, rms_limits_, brief_limits_;
  double planned_ = 0;  ///< planned mean square of the burst's samples
  AlignedBlocks blocks_;
  int window_blocks_;
  int blocks_taken_ = 0;  ///< number of blocks in the current window
  bool measured_ = false;
  double energy_ = 0, largest_ = 0, largest_block_ = 0;
  std::vector<double> window_, loudest_;  ///< samples of the current window and of the loudest one
};

}  // namespace turnpoint::sensing
