#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/trial_finger.hpp"

namespace turnpoint::session {

/// Amplitude of the carrier that excites the bridges of force cells; 1 is full scale.
constexpr double kCarrier = 0.5;
/// Load at which a force cell is at full scale.
constexpr double kRated_N = 10;

/// What the pick-ups of a rig capture, and how it is judged.
struct CaptureSetup {
  int rate_Hz = 192000;
  int channels = 1;                       ///< captured channels
  std::vector<sensing::PickUp> pick_ups;  ///< the pick-ups with their calibration; at least one
  double delay_frames = 0;                ///< from a played to a captured frame
  std::optional<bool> in_contact;         ///< whether a finger was on the surface, if that is known
  sensing::ProofLimits limits;
  std::optional<sensing::FingerSetup> finger;  ///< the force cells, if there are any
};

/// The pick-ups of a rig, with the responses of its calibration.
std::vector<sensing::PickUp> calibrated_pick_ups(const rig::Capture& capture);

/// Lets `finger` use the rig's calibration of the force cells.
void use(const rig::ForceCells& cells, sensing::FingerSetup& finger);

/// Proves the intervals of a trial from what the pick-ups capture, and measures the finger with the force
/// cells. One thread may push samples while the session thread calls the other functions.
class VibrationWatch {
 public:
  explicit VibrationWatch(CaptureSetup setup);

  /// The delay that the newest pilot has measured; it applies from the next trial on.
  void set_delay(double frames);
  /// The resonances have moved by this share since the calibration; it applies from the next trial on.
  void set_drift(double share);

  /// The intervals of a trial, with absolute start frames, in order. Replaces those of the previous trial.
  /// Until playback frame `quiet_until` the participant has not been asked to touch the surface.
  void expect(std::span<const drive::PreparedBurst> intervals, std::int64_t quiet_until);
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
  /// The finger at this moment. Empty if it is not known, and without force cells.
  std::optional<sensing::FingerNow> finger_now();
  /// What the force cells say about the trial, once its last interval is known. Null for the other intervals,
  /// and without force cells.
  std::shared_ptr<const sensing::TrialForces> forces(std::size_t interval);

 private:
  CaptureSetup setup_;
  const std::vector<sensing::PickUp> calibrated_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<sensing::IntervalProof>> proofs_;  ///< null: will not be proven
  std::optional<sensing::TrialFinger> finger_;
};

}  // namespace turnpoint::session
