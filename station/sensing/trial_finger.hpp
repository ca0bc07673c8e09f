#pragma once
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "station/sensing/capture_block.hpp"
#include "station/sensing/carrier.hpp"
#include "station/sensing/finger_track.hpp"
#include "station/sensing/force_calibration.hpp"
#include "station/sensing/friction_profile.hpp"

namespace turnpoint::sensing {

/// The movement that the participant is asked to make.
struct MovementWindow {
  static constexpr double any = std::numeric_limits<double>::infinity();

  double least_normal_N = 0, most_normal_N = any;      ///< allowed normal force, ends included
  double least_speed_mm_s = 0, most_speed_mm_s = any;  ///< allowed speed, ends included
  double fraction = 0.8;  ///< required fraction of the strokes' time with force and speed in range
  int strokes = 0;        ///< least number of strokes in a trial
};

/// Whether the participant moved as asked. If a movement has several faults, the first in this list is given.
enum class Movement {
  ok,
  strokes,  ///< too few strokes
  light,    ///< too little normal force
  hard,     ///< too much normal force
  slow,
  fast,
};
const char* name(Movement movement);

/// What the finger did during one trial. Quantities that could not be measured are NaN.
struct TrialSummary {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  double contact_s = 0;
  int strokes = 0;
  /// Mean and standard deviation of normal force over all strokes.
  double normal_N = none, normal_sd_N = none;
  /// fraction of the strokes' time with normal force in the window; NaN if any force is allowed
  double normal_in_window = none;
  double speed_mm_s = none;  ///< mean absolute speed over all strokes
  /// fraction of the strokes' time with speed in the window; NaN if any speed is allowed
  double speed_in_window = none;
};

/// Summarises the forces and the movement of the finger in one trial.
TrialSummary summarise(std::span<const FingerPoint> track, Band band, std::span<const Stroke> strokes,
                       const MovementWindow& window);

Movement judge(const TrialSummary& summary, const MovementWindow& window);

/// The force cells of a rig, and how their readings are used.
struct FingerSetup {
  BridgeOptions bridges;
  ForceCalibration calibration{{}, {}};
  MovementWindow window;
  double length_mm = 0;  ///< length of the strip, in which a step of friction is looked for
  /// The cells have a converter with a clock of its own, whose points are pushed; otherwise they are captured
  /// by the card that plays.
  bool own_clock = false;
};

/// Whether the forces of a trial are known.
enum class ForcesState {
  ok,
  lost,  ///< captured frames are missing
  wire,  ///< a bridge or the reference has a wire fault
  tare,  ///< the zero of the cells is not known: something lay on the surface, or it was never quiet
};
const char* name(ForcesState state);

/// What the finger did in one trial. The track covers the trial from before the first interval to the end of
/// the last.
struct TrialForces {
  ForcesState state = ForcesState::lost;
  std::optional<std::size_t>
      faulty_bridge;        ///< which bridge has a wire fault; empty if none or if all have it
  double tare_moved_N = 0;  ///< change of the force zero since the previous tare
  /// Reading of each cell (a, b, lateral) before the trial and its standard deviation, relative to the cell's
  /// full scale; empty if captured frames are missing.
  std::optional<Readings> zero, noise;
  TrialSummary summary;
  FrictionProfile profile;  ///< friction along the strip during the last interval
  Movement movement = Movement::ok;
  std::vector<Stroke> strokes;  ///< the strokes of the last interval, as ranges of `track`
  std::vector<FingerPoint> track;
  std::int64_t frames_per_point = 0;  ///< point k is at playback frame k * frames_per_point
};

/// The finger at this moment. A participant may see force and speed, and the operator all of it. Lateral
/// force and friction are left out on purpose, because they would reveal the answer.
struct FingerNow {
  double normal_N = 0;    ///< mean over the last tenth of a second
  double speed_mm_s = 0;  ///< mean over the last tenth of a second; NaN if it is not known
  bool contact = false;
  double position_mm = 0;  ///< newest known position, from the wide edge; NaN if it is not known
};

/// Measures the finger in one trial after another from captured frames, which must have the numbers at which
/// they were played, or from points (`FingerSetup::own_clock`). Not thread-safe; allocates.
class TrialFinger {
 public:
  /// Before the trial, the force cells are read for this long without a finger on the surface (tare).
  static constexpr double tare_s = 0.4;
  /// Captured frames are needed up to this long after the last interval.
  static constexpr double tail_s = 0.06;

  explicit TrialFinger(const FingerSetup& setup);

  /// Playback frames in which one interval of the trial is presented.
  struct Range {
    std::int64_t first_frame = 0, end_frame = 0;
  };
  /// Announces the intervals of the next trial. The tare is taken from what was captured before
  /// `quiet_until`. Points that the trial does not need are dropped.
  void expect(std::int64_t quiet_until, std::vector<Range> intervals);
  /// Call this if playback was cut at this frame. An interval that had begun ends there, and later ones do
  /// not take place.
  void cut(std::int64_t frame);
  void push(const CaptureBlock& block);
  /// Takes a point of cells that have a clock of their own. Points that were left out count as lost; points
  /// that were already received are ignored.
  void push(const BridgePoint& point);

  /// Readings of the cells without a finger: those before the expected trial, or the newest before them if
  /// something lay on the surface. Empty if there are none. Call it once what was captured before
  /// `quiet_until` has been pushed.
  std::optional<Readings> zero();

  /// The result of the expected trial is known once all playback frames before this one have been captured.
  std::int64_t known_at() const;
  /// True if a finger touched the surface in this interval; empty if that is not known.
  std::optional<bool> contact(std::size_t interval);
  /// What the finger does in the newest captured frames. Empty if no trial is expected, or its forces are not
  /// known.
  std::optional<FingerNow> now();
  /// Returns what was measured in the expected trial. Frames that have not been captured when this is called
  /// count as lost.
  TrialForces result();

 private:
  void keep_from(std::int64_t index);
  void take_tare();
  void describe(const std::vector<BridgePoint>& quiet);
  ForcesState state_of(std::int64_t first, std::int64_t end) const;
  std::vector<FingerPoint> track(std::int64_t first, std::int64_t end) const;
  std::int64_t index_at(std::int64_t frame) const { return frame / frames_per_point_; }
  std::int64_t points_in(double seconds) const { return static_cast<std::int64_t>(seconds * points_per_s_); }

  FingerSetup setup_;
  BridgeDemodulator demodulator_;
  std::int64_t frames_per_point_;
  double points_per_s_;
  std::int64_t next_frame_ = 0;  ///< number of the next captured frame, if none is missing
  std::deque<BridgePoint> points_;
  std::optional<Readings> zero_;  ///< readings at the newest tare (cells without a finger)
  /// mean and standard deviation of the readings from which the newest tare was taken, relative to full scale
  std::optional<Readings> read_, noise_;
  bool tared_ = false;   ///< take_tare() has been called for the expected trial
  bool loaded_ = false;  ///< something lay on the surface during the tare
  double tare_moved_N_ = 0;
  std::int64_t quiet_until_ = 0;
  std::vector<Range> intervals_;  ///< intervals of the expected trial; empty if no trial is expected
};

}  // namespace turnpoint::sensing
