#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/audio/amplifier.hpp"
#include "station/audio/burst.hpp"
#include "station/audio/engine.hpp"
#include "station/rig/rig.hpp"
#include "station/session/capture_feed.hpp"
#include "station/session/devices.hpp"
#include "station/session/follow_loop.hpp"
#include "station/session/inputs.hpp"
#include "station/session/simulated_participant.hpp"
#include "station/session/simulated_room.hpp"
#include "station/session/triggers.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

/// The time at which a burst reaches the surface, in ns and in frames.
struct Onset {
  std::int64_t frame = 0;
  std::int64_t time_ns = 0;
};

/// The regression line of time over frames, from which the drive computes the times of onsets: its slope and
/// its residual.
struct ClockFit {
  double slope_ns_per_frame = 0;
  double residual_ns = 0;
};

/// A deadline that never comes, for waits without a limit.
constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// What a session runs on: its clock, drive, amplifier and inputs. There are two kinds: the real stage
/// (CLOCK_MONOTONIC, a person) and the virtual stage (a simulated observer, as fast as possible). The rest of
/// the session is the same code for both. Use a stage from one thread.
class Stage {
 public:
  virtual ~Stage() = default;

  virtual std::int64_t now_ns() = 0;

  /// Waits for the next input with a time stamp up to `deadline_ns`. Returns nothing once that time has come.
  virtual std::optional<Input> wait_until(std::int64_t deadline_ns) = 0;

  /// Removes all waiting inputs before a new trial, and returns them for the log.
  virtual std::vector<Input> drain() = 0;

  /// Waits until `ready` returns true because another thread has finished its work. Reports to the amplifier
  /// guard meanwhile. The virtual clock stands still during the wait.
  virtual void wait_for(const std::function<bool()>& ready) = 0;

  /// Schedules the intervals of a trial. The first interval begins at the earliest safe frame that is not
  /// before `earliest_ns`; the distances between intervals are exactly those of their start frames. Returns
  /// the onsets. If scheduling fails, returns nothing and pushes a fault to the inputs. Later, the inputs
  /// report lost frames (input::Xrun), and each interval that was played completely (input::Heard).
  virtual std::vector<Onset> present(std::span<const audio::PreparedBurst> intervals,
                                     std::int64_t earliest_ns) = 0;

  /// Prepares the intervals of the next call of present() that follow the finger; the bursts are those that
  /// it will present. Call it before each trial; without plans it does nothing. Throws audio::BurstRefused if
  /// the stage cannot follow a plan.
  virtual void follow(const FollowPlans& plans, std::span<const audio::PreparedBurst> intervals);
  /// What the intervals have done that were presented last and follow the finger.
  virtual Followed followed() { return {}; }

  /// Makes the burst that is playing glide to other tones within `seconds`, beginning now. Returns the frame
  /// at which the glide begins. If no burst is playing, or the burst is about to end, does nothing and
  /// returns nothing.
  virtual std::optional<std::int64_t> glide(const audio::ToneSet& to, double seconds) = 0;

  /// Ramps all bursts down now, and cancels those that have not begun. Returns the time at which the surface
  /// will be silent. If the converter does not report its position, this time is an upper limit; if the
  /// converter is gone, it is the time of the loss.
  /// `awaits_heard` says that the trial has not ended: it still waits for the report that each interval was
  /// played (input::Heard). No such report comes for an interval that is cancelled, so a fault comes
  /// instead.
  virtual std::int64_t silence(bool awaits_heard) = 0;

  /// Why the amplifier refused a command; empty if it did not.
  using Refusal = std::optional<Fault>;
  /// Commands of the operator to the amplifier.
  [[nodiscard]] virtual Refusal arm() = 0;
  virtual void disarm() = 0;
  [[nodiscard]] virtual Refusal clear() = 0;
  virtual audio::AmplifierState amplifier() const = 0;
  /// Switches the amplifier on before the stimuli of a trial, while the drive is silent.
  [[nodiscard]] virtual Refusal open_amplifier() = 0;
  /// Switches the amplifier off after the stimuli, as soon as the surface is silent.
  virtual void close_amplifier() = 0;

  /// Sends and checks the trigger codes of this run of the program.
  virtual Triggers& triggers() = 0;

  /// Names of the rig's response buttons, in the order of their indices.
  virtual const std::vector<std::string>& buttons() const = 0;
  /// Names the lines (buttons, contact) that are disconnected at present, with the reason; "" if none are.
  virtual std::string missing() const = 0;

  /// For the self-test. guarded_amplifier() is null in a simulated session; the capture is that of the
  /// simulated room, and empty without a room.
  virtual audio::Amplifier* guarded_amplifier() { return nullptr; }
  virtual std::optional<CaptureSetup> capture() const { return std::nullopt; }

  /// What judges the captured signals; null if the stage captures nothing.
  virtual VibrationWatch* watch() { return nullptr; }

  virtual std::optional<ClockFit> clock_fit() = 0;
  virtual std::string realtime_rights() const = 0;
  /// Disarms the amplifier. If the output is a file, completes the file. Throws std::system_error.
  virtual void finish() = 0;
};

/// Returns the configuration of the stream for a rig's output, with a channel for each transducer.
audio::StreamConfig stream_of(const rig::Rig& rig);
/// Like stream_of(), with the carrier that excites the bridges of force cells.
audio::StreamConfig session_stream(const rig::Rig& rig);
/// True if the rig captures the signals of a simulated surface and finger instead of a sound card's.
bool simulates_capture(const rig::Rig& rig);
/// Returns the configuration of a simulated session's stream. It uses no hardware: if the rig's output is a
/// converter, samples are discarded. Output to files and to plug-ins that the rig allows is kept.
audio::StreamConfig simulated_stream(const rig::Rig& rig);

/// Makes a stage that runs in real time: CLOCK_MONOTONIC, the audio thread, the amplifier guard, and inputs
/// from a display and the touch panel. `inputs` must outlive the stage. With a `capture`, the surface is
/// measured: a pilot aligns playback and capture before the amplifier is enabled, unless they are aligned
/// already.
std::unique_ptr<Stage> real_stage(const audio::StreamConfig& stream, Devices devices, Inputs& inputs,
                                  const std::optional<CardCapture>& capture = std::nullopt,
                                  const TriggerSetup& triggers = {});

/// Makes a stage on the virtual clock. The drive advances with the clock. The participant's inputs come in
/// their time; the stage arms a simulated amplifier, and presses Continue when nothing else is left to do.
/// `participant` and `inputs` must outlive the stage. Of `inputs`, only a stop has an effect, and only
/// between trials. With a `room`, stimuli are computed sample by sample, and the surface is measured.
std::unique_ptr<Stage> virtual_stage(const audio::StreamConfig& stream, SimulatedParticipant& participant,
                                     Inputs& inputs, std::unique_ptr<SimulatedRoom> room = nullptr,
                                     const TriggerSetup& triggers = {});

}  // namespace turnpoint::session
