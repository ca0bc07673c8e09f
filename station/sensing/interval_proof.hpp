#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "station/audio/prepared_burst.hpp"
#include "station/sensing/capture_block.hpp"
#include "station/sensing/interval_result.hpp"
#include "station/sensing/pick_up.hpp"

namespace turnpoint::sensing {

/// What was planned for an interval. The measurement (proof) compares the captured samples with it.
struct IntervalPlan {
  audio::PreparedBurst burst;  ///< the planned burst; its start is an absolute frame
  int rate_Hz = 192000;
  int capture_channels = 6;
  std::vector<PickUp> pick_ups;  ///< the calibrated pick-ups; at least one
  double delay_frames = 0;       ///< delay from playback to capture, measured by the newest pilot
  ProofLimits limits;
};

/// Proves that the surface vibrated as planned during one interval. Amplitude, phase and residual come from
/// joint fits of all tones (JointFit) to windows of about 0.2 s, in the parts of the burst where nothing
/// changes, and to windows of about 5 ms in glides between two tone sets (GlideProof). The onset comes from
/// the envelope of a lock-in, and so does the offset (the ramp at the end). The capture may arrive in blocks
/// of any size. For an ordinary thread; not thread-safe.
///
/// Not measured: the ramps and the 5 ms after each, in which the plate settles; the residual in a glide,
/// masking noise and markers. Tones of equal frequency on several output channels are measured as one. If
/// tones are less than about 10 Hz apart, the interval stays unproven. So does a burst that follows gains:
/// FollowProof judges it.
class IntervalProof {
 public:
  /// Throws std::logic_error if there is no pick-up, or if a pick-up's channel is not captured.
  explicit IntervalProof(const IntervalPlan& plan);
  ~IntervalProof();
  IntervalProof(IntervalProof&&) noexcept;
  IntervalProof& operator=(IntervalProof&&) noexcept;

  /// The captured frames that the proof needs: from first_frame() to before end_frame(). They begin 25 ms
  /// before the onset.
  std::int64_t first_frame() const noexcept;
  std::int64_t end_frame() const noexcept;

  /// Takes captured frames in order. Ignores frames that it does not need.
  void push(const CaptureBlock& block);

  /// Call this if the burst was stopped. The result then contains only what was played before this absolute
  /// playback frame.
  void stopped(std::int64_t frame) noexcept;

  /// Call this when a change is sent while the burst plays. `format` is that of the output. The proof needs
  /// to know of a change before its captured frames arrive. If it does not, or if a change begins before the
  /// last one has ended, the interval stays unproven.
  void changed(const audio::Change& change, const audio::Format& format);

  /// True once all needed frames have been received.
  bool complete() const noexcept;

  /// The result. Frames that have not been received by now count as lost. `in_contact` says whether a finger
  /// was on the surface; leave it empty if that is not known. The reference is valid until the next call. The
  /// first call takes about 0.1 ms per tone and product if there is a residual to explain.
  const IntervalResult& result(std::optional<bool> in_contact = std::nullopt);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::sensing
