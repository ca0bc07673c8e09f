#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/sensing/interval_proof.hpp"

namespace turnpoint::session {

/// What the pick-ups of a rig capture, and how it is judged.
struct CaptureSetup {
  int rate_Hz = 192000;
  int channels = 1;                       ///< captured channels
  std::vector<sensing::PickUp> pick_ups;  ///< with their calibration; at least one
  double delay_frames = 0;                ///< from a played to a captured frame
  std::optional<bool> in_contact;         ///< whether a finger was on the surface, if that is known
  sensing::ProofLimits limits;
};

/// Proves the intervals of a trial from what the pick-ups capture. One thread may push samples while the
/// session thread calls the other functions.
class VibrationWatch {
 public:
  explicit VibrationWatch(CaptureSetup setup);

  /// The delay that the newest pilot has measured; it applies from the next trial on.
  void set_delay(double frames);

  /// The intervals of a trial, with absolute start frames, in order. Replaces those of the previous trial.
  void expect(std::span<const drive::PreparedBurst> intervals);
  /// All bursts ramp down from this playback frame on. Intervals that have not begun by then are dropped.
  void cut(std::int64_t from_frame);
  /// The interval glides to other tones, which is not measured: it stays unproven.
  void changed(std::size_t interval);

  /// True if one of the expected intervals needs captured frames from this range.
  bool needs(std::int64_t first_frame, std::int64_t end_frame) const;
  void push(const sensing::CaptureBlock& block);

  /// The captured frame before which the result of an interval is not known.
  std::int64_t known_at(std::size_t interval) const;
  /// The result of an interval. Frames that were not captured by now count as lost. Null if the interval is
  /// not expected.
  std::shared_ptr<const sensing::IntervalResult> result(std::size_t interval);

 private:
  CaptureSetup setup_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<sensing::IntervalProof>> proofs_;  ///< null: will not be proven
};

}  // namespace turnpoint::session
