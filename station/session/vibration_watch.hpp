#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "station/audio/prepared_burst.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/follow_proof.hpp"
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/raw_ring.hpp"
#include "station/sensing/silence_proof.hpp"
#include "station/sensing/trial_finger.hpp"

namespace turnpoint::session {

/// Amplitude of the carrier that excites the bridges of the force cells, relative to full scale.
constexpr double kCarrier = 0.5;
/// The load for which a force cell is rated.
constexpr double kRated_N = 10;

/// VibrationWatch::expect must be called at least this long before the onset. Otherwise too little of the
/// silence before the stimulus is left to be judged, and the trial is flagged.
constexpr std::int64_t kExpected_ns = 65'000'000;

/// What a rig captures, with the calibration and the limits by which the captured signals are judged.
struct CaptureSetup {
  int rate_Hz = 192000;
  int channels = 1;                       ///< number of captured channels
  std::vector<sensing::PickUp> pick_ups;  ///< the pick-ups with their calibration; at least one
  double delay_frames = 0;                ///< delay from playback to capture
  std::optional<bool> in_contact;         ///< whether a finger was on the surface, if that is known
  sensing::ProofLimits limits;
  std::optional<sensing::FingerSetup> finger;  ///< the force cells, if there are any
};

/// Returns the pick-ups of a rig, with their calibrated responses.
std::vector<sensing::PickUp> calibrated_pick_ups(const rig::Capture& capture);

/// Copies the calibration of the force cells from the rig to `finger`.
void use(const rig::ForceCells& cells, sensing::FingerSetup& finger);

/// The force cells of a rig; empty if they are not calibrated.
std::optional<sensing::FingerSetup> calibrated_finger(const rig::Rig& rig);

/// Judges the intervals of a trial, and the silence before the first of them, by the signals of the pick-ups,
/// and measures the finger with the force cells. One thread may push samples while the session thread calls
/// the other functions.
class VibrationWatch {
 public:
  explicit VibrationWatch(CaptureSetup setup);

  /// Sets the delay that the newest pilot has measured. It applies from the next trial on.
  void set_delay(double frames);
  /// Sets the fraction by which the resonance frequencies have risen since the calibration. It applies from
  /// the next trial on.
  void set_drift(double share);

  /// Announces the intervals of a trial, with absolute start frames, in order. They replace those of the
  /// previous trial. Nobody is asked to touch the surface before playback frame `quiet_until`. From then
  /// on, but at most for the last 80 ms before the first interval, the surface must be silent.
  /// `commanded` gives the gains that an interval has followed; result() calls it for intervals that follow
  /// gains.
  using Commanded = std::function<sensing::CommandedEnvelope(std::size_t interval)>;
  void expect(std::span<const audio::PreparedBurst> intervals, std::int64_t quiet_until,
              Commanded commanded = {});
  /// Tells the watch that all bursts ramp down from this playback frame on. Intervals that have not begun by
  /// then are dropped.
  void cut(std::int64_t from_frame);
  /// Tells the watch that this interval, which is playing, glides to other tones. `format` is that of the
  /// output.
  void changed(std::size_t interval, const audio::Change& change, const audio::Format& format);

  /// True if one of the expected intervals needs captured frames from this range.
  bool needs(std::int64_t first_frame, std::int64_t end_frame) const;
  void push(const sensing::CaptureBlock& block);
  /// A point of force cells that have a clock of their own.
  void push(const sensing::BridgePoint& point);

  /// Returns the captured frame after which the result of an interval is known.
  std::int64_t known_at(std::size_t interval) const;
  /// The result of an interval; that of the first one includes the silence before it. If fewer than 50 ms of
  /// the silence were captured, the interval is flagged with the cause `gap`. Frames that were not captured
  /// by now count as lost. Null if the interval is not expected.
  std::shared_ptr<const sensing::IntervalResult> result(std::size_t interval);
  /// Returns the captured frames of the last 4 s, numbered by playback frames, in which the delay from
  /// playback to capture is already compensated except for the fraction of a frame.
  sensing::RawCapture raw() const;
  /// Returns force and movement of the finger at this moment. Empty if they are not known, and without force
  /// cells.
  std::optional<sensing::FingerNow> finger_now();
  /// Readings of the force cells without a finger before the expected trial; see
  /// sensing::TrialFinger::zero().
  std::optional<sensing::Readings> zero();
  /// Returns what the force cells measured in the trial, if `interval` is its last interval. Null for other
  /// intervals, and without force cells.
  std::shared_ptr<const sensing::TrialForces> forces(std::size_t interval);

 private:
  CaptureSetup setup_;
  const std::vector<sensing::PickUp> calibrated_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<sensing::IntervalProof>> proofs_;
  std::vector<std::unique_ptr<sensing::FollowProof>>
      follow_proofs_;  ///< null for intervals that follow nothing
  Commanded commanded_;
  std::optional<sensing::SilenceProof> silence_;      ///< empty if no interval is expected
  std::int64_t silence_begin_ = 0, silence_end_ = 0;  ///< captured frames of the silence
  std::optional<sensing::TrialFinger> finger_;
  sensing::RawRing raw_;
};

}  // namespace turnpoint::session
