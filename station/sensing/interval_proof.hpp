#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/sensing/capture_block.hpp"
#include "station/sensing/interval_result.hpp"
#include "station/sensing/pick_up.hpp"

namespace turnpoint::sensing {

/// What an interval is measured against.
struct IntervalPlan {
  drive::PreparedBurst burst;  ///< as planned; its start is an absolute frame
  int rate_Hz = 192000;
  int capture_channels = 6;
  std::vector<PickUp> pick_ups;  ///< at least one
  double delay_frames = 0;       ///< of the loop, from the newest pilot
  ProofLimits limits;
};

/// Proves that the surface vibrated as planned during one interval. Amplitude, phase and residual come from
/// joint fits of all tones (JointFit) to windows of about 0.2 s within the steady stretches; the onset from
/// the envelope of a lock-in. Allocates only in its constructor. The capture may arrive in blocks of any
/// size. For an ordinary thread; not thread-safe.
///
/// Not measured: glides between two tone sets, changes that are sent while the burst plays, the falling ramp,
/// masking noise and markers. Tones of equal frequency on several output channels are measured as one. With
/// tones less than about 10 Hz apart the interval stays unproven.
class IntervalProof {
 public:
  /// Throws std::logic_error if there is no pick-up or one uses a channel that is not captured.
  explicit IntervalProof(const IntervalPlan& plan);
  ~IntervalProof();
  IntervalProof(IntervalProof&&) noexcept;
  IntervalProof& operator=(IntervalProof&&) noexcept;

  /// Captured frames that the proof needs: from the first to before the end. They include 25 ms before the
  /// onset.
  std::int64_t first_frame() const noexcept;
  std::int64_t end_frame() const noexcept;

  /// Takes captured frames in order; ignores those that it does not need.
  void push(const CaptureBlock& block);

  /// The burst was stopped: from this absolute frame of the playback on it falls, and is not judged.
  void stopped(std::int64_t frame) noexcept;

  /// True if all frames have been received.
  bool complete() const noexcept;

  /// The result. Frames that have not been received by now count as lost. `in_contact` says whether a finger
  /// was on the surface, if that is known. The reference is valid until the next call; the first call takes
  /// about 0.1 ms per tone and product if there is a residual to explain.
  const IntervalResult& result(std::optional<bool> in_contact = std::nullopt);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::sensing
