#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "station/audio/alsa_capture.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/pilot.hpp"
#include "station/sensing/stillness_watch.hpp"
#include "station/session/cell_feed.hpp"
#include "station/session/follow_loop.hpp"
#include "station/session/triggers.hpp"
#include "station/session/vibration_watch.hpp"

namespace turnpoint::session {

/// What a rig captures with the same sound card that plays, and how captured and played frames are aligned.
struct CardCapture {
  audio::OutputConfig device;
  CaptureSetup setup;
  sensing::Pilot pilot;
  int reference = 0;  ///< captured channel on which the pilot is recorded
  TriggerSetup triggers;
  std::optional<CellPlan> cells = {};  ///< calibrated force cells that the card does not capture
};

/// Returns nothing unless the rig's section [capture] names an `alsa:` device.
std::optional<CardCapture> card_capture_of(const rig::Rig& rig);

/// Passes captured samples to a VibrationWatch, numbered by playback frames. A pilot establishes this
/// numbering; it is lost when the capture loses frames or the playback is restarted. Until the next pilot the
/// watch gets no samples, so an interval during that time counts as lost. The samples are processed on an
/// ordinary thread.
class CaptureFeed {
 public:
  CaptureFeed(std::unique_ptr<audio::Capture> capture, const CardCapture& plan);

  VibrationWatch& watch() { return watch_; }
  const VibrationWatch& watch() const { return watch_; }
  TriggerCapture& triggers() { return triggers_; }

  bool aligned() const;
  /// How captured frames are numbered, if that is known.
  std::optional<Alignment> alignment() const;
  /// Calls the listener with everything that is captured from now on; it must outlive the feed.
  void set_listener(audio::CaptureListener& listener) { capture_->listen(listener); }
  /// Call this after the playback was restarted: the delay from playback to capture is then unknown until the
  /// next pilot.
  void misalign();
  /// All playback frames before this one have been captured and passed to the vibration watch.
  std::int64_t end_frame() const;

  /// Call this when the amplifier has been switched off, and before it is switched on. While it is off, the
  /// surface must be still, whether playback and capture are aligned or not.
  void amplifier_is_off();
  void amplifier_goes_on();
  /// Returns, once, a vibration that was captured while the amplifier was off.
  std::optional<sensing::Disturbance> disturbance();

  enum class Pilot { awaited, heard, missing };
  /// Call this once the pilot has been scheduled, before it is played.
  void listen(std::int64_t start_frame);
  Pilot pilot() const;
  double longest_wait_s() const { return longest_wait_s_; }

  audio::CaptureCounters counters() const { return capture_->counters(); }
  system::Rights rights() const { return capture_->rights(); }

 private:
  void run(const std::stop_token& stop);
  bool take(const audio::CapturedBlock& block);
  void conclude();

  std::unique_ptr<audio::Capture> capture_;
  const CardCapture plan_;
  const double longest_wait_s_;
  VibrationWatch watch_;
  TriggerCapture triggers_;
  mutable std::mutex mutex_;
  std::unique_ptr<sensing::PilotListener> listener_;  ///< null: no pilot is awaited
  Pilot pilot_ = Pilot::missing;
  std::int64_t shift_ = 0;       ///< playback frame minus captured frame; while listening, only a first guess
  std::uint32_t numbering_ = 0;  ///< value of the capture's `numbering` for which shift_ holds
  bool aligned_ = false;
  std::int64_t end_frame_ = 0;
  std::optional<sensing::StillnessWatch> stillness_;  ///< empty while the amplifier is on
  std::int64_t still_from_ = 0;  ///< frame of the capture device from which the surface must be still
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::session
