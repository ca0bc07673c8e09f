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

/// When a burst reaches the surface, in both of the session's units.
struct Onset {
  std::int64_t frame = 0;
  std::int64_t time_ns = 0;
};

/// The straight line between frames and time that onsets were predicted by.
struct ClockFit {
  double slope_ns_per_frame = 0;
  double residual_ns = 0;
};

/// A deadline that never comes.
constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// Time, drive, amplifier and inputs of one run. Two exist: real (CLOCK_MONOTONIC, a person) and virtual
/// (a simulated observer, as fast as the machine goes); the session above is the same code on both. All on
/// one thread.
class Stage {
 public:
  virtual ~Stage() = default;

  virtual std::int64_t now_ns() = 0;

  /// The next input stamped no later than `deadline_ns`, or none once that time has come.
  virtual std::optional<Input> wait_until(std::int64_t deadline_ns) = 0;

  /// Throws away what has gathered, for a fresh start; returns it for the log.
  virtual std::vector<Input> drain() = 0;

  /// Comes back once `ready` holds, which another thread brings about; keeps the amplifier's guard content.
  /// The virtual clock stands still meanwhile.
  virtual void wait_for(const std::function<bool()>& ready) = 0;

  /// Schedules the intervals of a trial: the first at the soonest frame that is safely ahead and no earlier
  /// than `earliest_ns`, the others at exactly the distances of their start frames from it. Returns their
  /// onsets; none where nothing can be scheduled, which is then told as a fault among the inputs. So are,
  /// later, frames that were lost (InputKind::xrun), and each interval once it has been heard whole
  /// (InputKind::heard).
  virtual std::vector<Onset> present(std::span<const drive::PreparedBurst> intervals,
                                     std::int64_t earliest_ns) = 0;

  /// What sounds glides to other tones within `seconds`, from now on. Returns the frame at which it begins;
  /// none, and nothing happens, when nothing sounds or it is about to end.
  virtual std::optional<std::int64_t> glide(const drive::ToneSet& to, double seconds) = 0;

  /// Ramps whatever sounds down, now, and cancels what has not begun. Returns when the surface will be
  /// silent, or is sure to be where the converter does not tell; when it fell silent where the converter is
  /// gone.
  virtual std::int64_t silence() = 0;

  /// Why the amplifier does not do what was asked; none when it was done.
  using Refusal = std::optional<Fault>;
  /// The amplifier, by the operator: arms, disarms, clears.
  [[nodiscard]] virtual Refusal arm() = 0;
  virtual void disarm() = 0;
  [[nodiscard]] virtual Refusal clear() = 0;
  virtual drive::AmplifierState amplifier() const = 0;
  /// Before the stimuli of a trial, in silence: amplifier on.
  [[nodiscard]] virtual Refusal open_amplifier() = 0;
  /// After them: amplifier off as soon as the surface is silent.
  virtual void close_amplifier() = 0;

  /// Names of the rig's response buttons, in the order of their indices.
  virtual const std::vector<std::string>& buttons() const = 0;
  /// What of buttons and contact has gone and is not back yet, and why; "" when all is there.
  virtual std::string missing() const = 0;

  /// Tells a simulated observer that this answer will be wanted, counted from `zero_ns`; nobody else listens.
  virtual void question(const observer::Question& question, std::int64_t zero_ns) = 0;

  /// Tells it to move a slider, counted from `zero_ns`, and then to press Done.
  virtual void adjustment(const observer::Adjustment& adjustment, std::int64_t zero_ns) = 0;

  virtual std::optional<ClockFit> clock_fit() = 0;
  virtual std::string realtime_rights() const = 0;
  /// Amplifier disarmed; completes a rendered output file. Throws std::system_error.
  virtual void finish() = 0;
};

/// The stream that a rig's output asks for, with a channel for each of its transducers.
drive::StreamConfig stream_of(const rig::Rig& rig);

/// Real time: CLOCK_MONOTONIC, the audio thread, the amplifier's guard, inputs from a display and the panel.
/// `inputs` must outlive it.
std::unique_ptr<Stage> real_stage(const drive::StreamConfig& stream, Devices devices, Inputs& inputs);

/// The virtual clock: the drive advances with it, and the observer answers and arms what amplifier there
/// would be. With nothing to wait for, the observer presses Continue. Of `inputs`, which must outlive it, it
/// hears a stop alone, and between two trials.
std::unique_ptr<Stage> virtual_stage(const drive::StreamConfig& stream, observer::Observer observer,
                                     Inputs& inputs);

}  // namespace turnpoint::session
