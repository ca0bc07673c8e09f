#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/drive/amplifier.hpp"
#include "station/drive/burst.hpp"
#include "station/drive/engine.hpp"
#include "station/observer/observer.hpp"
#include "station/rig/rig.hpp"
#include "station/session/devices.hpp"
#include "station/session/inputs.hpp"

namespace turnpoint::session {

/// The time at which a burst reaches the surface, in ns and in frames.
struct Onset {
  std::int64_t frame = 0;
  std::int64_t time_ns = 0;
};

/// The linear relation between frames and time that was used to predict onsets.
struct ClockFit {
  double slope_ns_per_frame = 0;
  double residual_ns = 0;
};

/// A deadline that never comes.
constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// Time, drive, amplifier and inputs of one run. There are two: real (CLOCK_MONOTONIC, a person) and virtual
/// (a simulated observer, as fast as possible). The code of the session is the same for both. Use it from one
/// thread.
class Stage {
 public:
  virtual ~Stage() = default;

  virtual std::int64_t now_ns() = 0;

  /// Waits for the next input stamped no later than `deadline_ns`; empty once that time has come.
  virtual std::optional<Input> wait_until(std::int64_t deadline_ns) = 0;

  /// Removes all waiting inputs for a fresh start, and returns them for the log.
  virtual std::vector<Input> drain() = 0;

  /// Waits until `ready` returns true, which another thread brings about. Keeps reporting to the amplifier's
  /// guard meanwhile. The virtual clock stands still during the wait.
  virtual void wait_for(const std::function<bool()>& ready) = 0;

  /// Schedules the intervals of a trial. The first begins at the earliest safe frame that is not before
  /// `earliest_ns`, the others at exactly the distances of their start frames from it. Returns their onsets.
  /// If nothing can be scheduled, returns nothing and reports a fault among the inputs. Lost frames
  /// (InputKind::xrun), and each interval that was played completely (InputKind::heard), are reported there
  /// later.
  virtual std::vector<Onset> present(std::span<const drive::PreparedBurst> intervals,
                                     std::int64_t earliest_ns) = 0;

  /// Makes the sounding burst glide to other tones within `seconds`, beginning now. Returns the frame at
  /// which the glide begins. If nothing sounds, or it is about to end, does nothing and returns nothing.
  virtual std::optional<std::int64_t> glide(const drive::ToneSet& to, double seconds) = 0;

  /// Ramps everything down now, and cancels what has not begun. Returns the time at which the surface will be
  /// silent: an upper limit if the converter does not report its position, and the time of the loss if the
  /// converter is gone.
  virtual std::int64_t silence() = 0;

  /// The reason why the amplifier refused; empty on success.
  using Refusal = std::optional<Fault>;
  /// For the operator: arms, disarms and clears the amplifier.
  [[nodiscard]] virtual Refusal arm() = 0;
  virtual void disarm() = 0;
  [[nodiscard]] virtual Refusal clear() = 0;
  virtual drive::AmplifierState amplifier() const = 0;
  /// Switches the amplifier on in silence, before the stimuli of a trial.
  [[nodiscard]] virtual Refusal open_amplifier() = 0;
  /// Switches the amplifier off after the stimuli, as soon as the surface is silent.
  virtual void close_amplifier() = 0;

  /// Names of the rig's response buttons, in the order of their indices.
  virtual const std::vector<std::string>& buttons() const = 0;
  /// Which of buttons and contact are lost at present, and why; "" if none.
  virtual std::string missing() const = 0;

  /// Asks a simulated observer to answer this question, with times counted from `zero_ns`. A real stage
  /// ignores it.
  virtual void question(const observer::Question& question, std::int64_t zero_ns) = 0;

  /// Asks a simulated observer to set this slider and press Done, with times counted from `zero_ns`.
  virtual void adjustment(const observer::Adjustment& adjustment, std::int64_t zero_ns) = 0;

  virtual std::optional<ClockFit> clock_fit() = 0;
  virtual std::string realtime_rights() const = 0;
  /// Disarms the amplifier and completes a rendered output file. Throws std::system_error.
  virtual void finish() = 0;
};

/// The stream for a rig's output, with a channel for each of its transducers.
drive::StreamConfig stream_of(const rig::Rig& rig);

/// A stage in real time: CLOCK_MONOTONIC, the audio thread, the amplifier's guard, inputs from a display and
/// the panel. `inputs` must outlive the stage.
std::unique_ptr<Stage> real_stage(const drive::StreamConfig& stream, Devices devices, Inputs& inputs);

/// A stage on the virtual clock. The drive advances with the clock, and the observer answers and arms a
/// simulated amplifier. If there is nothing to wait for, the observer presses Continue. `inputs` must outlive
/// the stage; only `stop` is honoured, and only between trials.
std::unique_ptr<Stage> virtual_stage(const drive::StreamConfig& stream, observer::Observer observer,
                                     Inputs& inputs);

}  // namespace turnpoint::session
