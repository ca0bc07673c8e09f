#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/engine.hpp"
#include "station/audio/ring.hpp"
#include "station/follow/record.hpp"
#include "station/sensing/follow_proof.hpp"
#include "station/sensing/force_calibration.hpp"
#include "station/sensing/trial_finger.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::session {

/// The plan of each interval of a trial that follows the finger; null for the others.
using FollowPlans = std::vector<std::shared_ptr<const follow::Plan>>;

/// The force cells of a rig as station/follow uses them. `tare` has the readings without a finger.
follow::Bridges bridges_of(const sensing::FingerSetup& finger, const sensing::Readings& tare);

/// How captured frames are numbered: playback frame minus captured frame, with the delay from playback to
/// capture subtracted, and the value of CapturedBlock::numbering for which that holds.
struct Alignment {
  std::int64_t shift = 0;
  std::uint32_t numbering = 0;
};

/// How the converters' delay that a plan was made with compares with what the loop sees: how far the stream
/// has rendered when a period has been captured. Right if it is neither too short nor too long.
struct DelayCheck {
  double stated_s = 0;
  /// With this delay the gains would come just in time, at the best and at the worst of the captured periods
  /// of the last tenth of a second. Below 0 if the device buffers less than was planned.
  double least_s = 0, most_s = 0;
  double period_s = 0;

  bool too_short() const { return stated_s < least_s; }           ///< no gain would ever come in time
  bool tight() const { return stated_s < most_s; }                ///< not all gains would
  bool too_long() const { return stated_s > most_s + period_s; }  ///< more than a period is wasted
  /// Says which of these it is, with both delays.
  std::string sentence() const;
};

/// What the intervals of a trial did that follow the finger.
struct Followed {
  /// The updates whose gains were played, in the order in which they were made.
  std::vector<follow::Recorded> periods;
  /// Frames from which a burst went to its resting gain because its gains came too late, and those from which
  /// it followed them again.
  struct Late {
    std::uint32_t burst = 0;
    std::int64_t from_frame = 0, to_frame = INT64_MAX;
  };
  std::vector<Late> late;
  std::int64_t cut_frame = INT64_MAX;  ///< from here on the bursts were ramped down
  std::int64_t not_recorded = 0;       ///< updates that nobody has taken in time
};

/// The way from the finger to the gain: takes captured frames on the capture's own thread, updates the
/// followers of the trial at the end of each period, and sends their gains to the audio thread. The session
/// thread prepares a trial before, and takes what was done. captured() is for the capture's thread; the other
/// functions are for the session thread.
class FollowLoop final : public audio::CaptureListener {
 public:
  /// The stream must outlive this object; `channels` is the number of captured channels. If the stream asked
  /// for real-time rights, the memory of the loop and of each trial is locked.
  FollowLoop(audio::Stream& stream, int channels);
  ~FollowLoop() override;

  /// Makes the followers of the next trial, whose bursts have these plans; `finger` are its force cells. A
  /// trial in which nothing follows the finger ends the loop. Throws audio::BurstRefused, with the reason,
  /// for a plan that cannot be followed.
  void prepare(const FollowPlans& plans, std::span<const audio::PreparedBurst> bursts,
               const std::optional<sensing::FingerSetup>& finger);
  /// Why memory could not be locked; empty if it is, or need not be.
  const std::string& not_locked() const { return not_locked_; }
  /// True if something follows the finger in the trial for which prepare() was called last.
  bool prepared() const { return next_ != nullptr; }
  /// Compares the delay that the prepared trial was planned with. Empty if nothing is prepared, or if too
  /// little was captured since this numbering began.
  std::optional<DelayCheck> check_delay(const Alignment& alignment) const;
  /// Begins the prepared trial, whose bursts were scheduled with these numbers and frames. Without a `tare`
  /// the forces are not known, so all of them rest.
  struct Burst {
    std::uint32_t burst = 0;
    std::int64_t start_frame = 0, end_frame = 0;
  };
  void begin(std::span<const Burst> bursts, const std::optional<sensing::Readings>& tare,
             const Alignment& alignment);
  /// Ends the trial: no more gains are sent.
  void end();

  /// Call this if all bursts are ramped down from this frame on. What comes later is not recorded.
  void cut(std::int64_t frame);
  /// Call this for each event of the stream.
  void note(const audio::Event& event);
  /// Moves what was done to the session's side; call it at least once a second.
  void gather();
  /// The gains that an interval of the trial has played so far, as far as they are known.
  sensing::CommandedEnvelope commanded(std::size_t interval);
  /// What was done since begin().
  Followed take();

  void captured(std::int64_t first_frame, std::uint32_t numbering,
                std::span<const std::int32_t> samples) noexcept override;

 private:
  struct Trial;
  void lock(const std::vector<system::MemoryRange>& memory);
  void offer(std::unique_ptr<Trial> trial);
  void drop_unplayed();
  void update(Trial& trial, std::int64_t captured_end) noexcept;
  void watch_delay(std::int64_t captured_end, std::uint32_t numbering) noexcept;

  audio::Stream& stream_;
  const int channels_;
  std::atomic<Trial*> offered_{nullptr};  ///< from the session to the capture
  std::atomic<std::uint64_t> taken_{0};   ///< number of the newest trial that the capture has taken
  std::unique_ptr<audio::Ring<follow::Recorded, 4096>> done_ =
      std::make_unique<audio::Ring<follow::Recorded, 4096>>();
  std::atomic<std::int64_t> not_recorded_{0};
  /// Frames rendered minus frames captured, at the ends of captured blocks: extremes over kAheadBlocks of
  /// them.
  struct Ahead {
    std::int64_t least = INT64_MAX, most = INT64_MIN;
    std::uint32_t numbering = 0;
    int blocks = 0;
  };
  static constexpr int kAheadBlocks = 200;
  /// The newest complete one. A sequence lock: the capture writes, and an odd number means that it does so
  /// now.
  std::atomic<std::uint32_t> ahead_version_{0}, ahead_numbering_{0};
  std::atomic<std::int64_t> least_ahead_{0}, most_ahead_{0};
  // used by the session only
  std::unique_ptr<Trial> next_;
  Trial* current_ = nullptr;                 ///< the trial that was begun last; one of kept_
  std::deque<std::unique_ptr<Trial>> kept_;  ///< the capture may still use them
  std::uint64_t last_number_ = 0;
  std::string not_locked_;
  bool active_ = false;  ///< a trial was begun, and has not ended
  struct Begun {
    std::size_t interval = 0;
    Burst burst;
    follow::Timing timing;
  };
  std::vector<Begun> begun_;
  Followed followed_;
  // used by the capture only
  Trial* trial_ = nullptr;
  Ahead ahead_;
};

}  // namespace turnpoint::session
