#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/interval_result.hpp"
#include "station/sensing/planned_lines.hpp"

namespace turnpoint::sensing {

/// The gains of a burst that follows gains, as they were commanded: gain k is that at playback frame
/// start_frame + k step_frames, with straight lines between them. NaN where it is not known which gain was
/// played.
struct CommandedEnvelope {
  std::int64_t start_frame = 0;
  int step_frames = 12;
  std::vector<double> gain;
};

/// Proves that the surface followed its gains in an interval whose burst follows them (audio::Following).
/// What the pick-up that sees the tones best should capture is computed from the commanded gains and its
/// calibrated response around each tone; the captured samples are compared with it in blocks of half a
/// millisecond.
///
/// All tones together have one level and one phase relative to the plan, by least squares over the interval.
/// What remains, relative to what was commanded, is the error of the envelope: everything that is not the
/// commanded vibration, with noise and products of distortion. The lag is the shift of the commanded envelope
/// that leaves least. Its standard error follows from the spectra of what remains and of the commanded
/// change; it is stated only if three standard errors are within the limit at which it flags a trial, and
/// counts as beyond a limit only if it is by three of them. Not measured: the ramps and the 5 ms after them,
/// and times at which the played gain is not known. For an ordinary thread; not thread-safe.
class FollowProof {
 public:
  /// Throws std::logic_error like IntervalProof. `plan` must have a single set of tones.
  explicit FollowProof(const IntervalPlan& plan);

  /// Takes captured frames in order. Ignores frames that it does not need.
  void push(const CaptureBlock& block);
  /// Call this if the burst was stopped at this playback frame.
  void stopped(std::int64_t frame) noexcept;
  /// The result. It is `unproven` if less than 50 ms of the interval can be judged, if the commanded gains
  /// were below 1 % (rms), or if the pick-ups do not see the tones.
  IntervalResult result(const CommandedEnvelope& commanded, std::optional<bool> in_contact) const;

 private:
  struct Block {
    std::int64_t first_frame = 0;
    bool lost = false;
    double energy = 0, largest = 0;
    std::vector<std::complex<double>> sums;  ///< of samples times i e^(-i phase), for each line
  };
  struct Expected;
  void take(const AlignedBlock& block);
  std::uint64_t phase_at(std::size_t line, std::int64_t captured_frame) const noexcept;

  IntervalPlan plan_;
  AlignedBlocks blocks_;
  std::vector<PlannedLine> lines_;
  std::int64_t origin_frame_ = 0;
  std::size_t pick_up_ = 0;
  std::int64_t first_ = 0, end_ = 0;  ///< captured frames that are judged
  std::vector<Block> taken_;
};

}  // namespace turnpoint::sensing
