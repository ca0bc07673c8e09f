#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/drive/amplifier.hpp"
#include "station/drive/burst.hpp"
#include "station/drive/frame_clock.hpp"
#include "station/drive/output.hpp"
#include "station/drive/prepared_burst.hpp"
#include "station/drive/rate_check.hpp"
#include "station/drive/synth.hpp"

namespace turnpoint::drive {

/// Rendered is not heard: a device is given each frame a buffer's length before it plays it. A burst that
/// began therefore ends twice: burst_ended when its last frame is rendered, and burst_heard when that has
/// been played and none of its frames were lost. The underrun that costs a burst frames names it instead.
enum class EventKind : std::int32_t {
  burst_started,  ///< frame: first frame of the burst, as scheduled
  burst_ended,    ///< frame: first silent frame; the burst's first one where it was stopped before it began
  burst_heard,   ///< frame: first silent frame; every frame before it has left the device as it was scheduled
  burst_missed,  ///< the command came when its first frame was already rendered: nothing sounds
  underrun,      ///< frames [frame, frame + frames) were not played; what sounded goes on, ramped in
  device_lost,   ///< from `frame` on nothing is played until the device is back and the operator re-arms
  device_back,   ///< reopened by name; frames count on from `frame`
  rate_wrong,    ///< the measured rate is more than 200 ppm off (`frames`: the rate in mHz): stop the session
};

struct Event {
  EventKind kind = EventKind::burst_started;
  std::uint32_t burst =
      0;  ///< of an underrun or a loss: the first burst that lost frames by it; 0 where none did
  std::int64_t frame = 0;
  std::int64_t frames = 0;
  int error = 0;  ///< negative errno of the device, where there is one
  /// Of an underrun: the device was started anew, so what follows is played at another time than was
  /// predicted. A burst that was not heard to its end by then has lost frames, even if none of them fell into
  /// the gap.
  bool retimed = false;
};

struct Counters {
  std::int64_t frames = 0;  ///< rendered
  std::int64_t heard = 0;   ///< left the device, or were lost, as far as is known; losses before are reported
  std::int64_t bursts = 0;  ///< begun
  std::int64_t missed = 0;
  std::int64_t underruns = 0;
  std::int64_t lost_frames = 0;  ///< not played, by underruns
  std::int64_t saturated = 0;    ///< samples out of range: a fault if not 0
  std::int64_t device_losses = 0;
  std::int64_t events_dropped = 0;  ///< nobody polled
};

/// What the operating system granted to the audio thread, for the record and the screen.
struct Rights {
  bool asked = false;     ///< a synchronous stream asks for nothing
  int fifo_priority = 0;  ///< 0: not real time
  bool memory_locked = false;
  std::string note;  ///< why not, where something was denied
};

/// What a synchronous stream to `null:` does with its samples: computes them all the same, to measure them or
/// the cost; or passes them by with the same events at the same frames, for sessions without a listener.
enum class Samples : std::int32_t { rendered, passed };

struct StreamConfig {
  OutputConfig output;
  Samples samples = Samples::rendered;
  SynthLimits limits;
  int fifo_priority = 70;
  double converter_delay_s = 0;  ///< group delay of the converter, added to predicted times
  /// How far a synchronous stream renders ahead of what is heard, as a device with a buffer does: commands
  /// take effect so many frames later. Other streams have their device's buffer.
  std::int64_t virtual_lead_frames = 0;
  /// Told audio_alive() after each block that a device took; must outlive the stream. None: null.
  Amplifier* amplifier = nullptr;
};

/// A burst that was accepted, and the frame at which it begins.
struct Scheduled {
  std::uint32_t burst = 0;
  std::int64_t start_frame = 0;
};

/// A stream that runs on silence and plays bursts at absolute frames. All functions are for one control
/// thread; none of them blocks on the audio thread. Frames count from 0 at the opening, through underruns and
/// reopenings.
class Stream {
 public:
  virtual ~Stream() = default;

  /// Checks and sends a burst; returns its number (from 1). Throws BurstRefused (limits, sum of overlapping
  /// peaks, start frame already gone, too many waiting).
  virtual std::uint32_t schedule(const Burst& burst) = 0;
  /// Sends bursts that were checked for this stream's format and limits, in the order of their start frames
  /// and at exactly their distances: as they say or, where the first one could not be reached any more, all
  /// later by the same number of frames. Takes microseconds. Throws BurstRefused, and then none of them
  /// sounds.
  virtual std::vector<Scheduled> schedule_together(std::span<const PreparedBurst> bursts) = 0;
  /// Checks one burst, which can take longer than a buffer lasts (see prepare), and sends it as above.
  Scheduled schedule_soon(const Burst& burst);
  /// Changes a burst that waits or sounds; `at_frame` counts from its start. Throws BurstRefused.
  virtual void change(std::uint32_t burst, const Change& change) = 0;
  /// Ramps one burst (0: all) down as soon as possible, or from an absolute frame. Throws std::runtime_error
  /// when the audio thread takes no commands.
  virtual void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame = {}) = 0;

  /// The next event of the audio side, oldest first. To be called at least every few seconds: it also takes
  /// up the time stamps of the device, of which the audio thread can keep 2048.
  virtual std::optional<Event> poll() = 0;

  /// The soonest frame that a burst scheduled now is sure to reach.
  virtual std::int64_t earliest_frame() const = 0;
  /// Frames <-> CLOCK_MONOTONIC (virtual time for a synchronous stream). No pairs: nothing is known, as
  /// before the device has first told its position, while it is lost, and just after it was started anew.
  virtual ClockFit clock() = 0;
  /// Predicted time at which a frame leaves the converter, group delay included; ns. None while nothing is
  /// known.
  virtual std::optional<std::int64_t> time_of(std::int64_t frame) = 0;
  virtual std::optional<std::int64_t> frame_at(std::int64_t time_ns) = 0;

  /// What the clock of the device that is open was measured at; none before 2 s, and for streams without a
  /// device.
  virtual std::optional<MeasuredRate> measured_rate() = 0;
  virtual Counters counters() const = 0;
  virtual Rights rights() const = 0;
  virtual const StreamConfig& config() const = 0;
};

/// The virtual clock: no thread; the caller advances frames, as fast as the machine goes. Time starts at
/// `origin_ns` and is frame / rate exactly.
class SynchronousStream : public Stream {
 public:
  /// Renders and writes `frames` frames. Throws std::system_error where a file cannot be written.
  virtual void advance(std::int64_t frames) = 0;
  virtual std::int64_t frame() const = 0;     ///< the next one to be rendered
  virtual std::int64_t now_ns() const = 0;    ///< time of that frame
  virtual double largest_sample() const = 0;  ///< written so far, full scale
  /// Completes the output (file headers). Throws std::system_error.
  virtual void finish() = 0;
};

/// Throws as open_output, and terms::UsageError for a format that cannot be synthesised or samples that
/// would be missing from an output.
std::unique_ptr<SynchronousStream> open_synchronous(const StreamConfig& config, std::int64_t origin_ns = 0);

/// Opens the output and starts the audio thread: paced by ALSA, or by CLOCK_MONOTONIC for `null:` and `wav:`.
/// The destructor ramps down what sounds, and joins.
std::unique_ptr<Stream> open_realtime(const StreamConfig& config);

/// What a `play` did.
struct PlayReport {
  Counters counters;
  Rights rights;
  ClockFit clock;
  std::optional<MeasuredRate> rate;  ///< of a device that played for 2 s or more
  double peak = 0;                   ///< computed before playing, full scale
  double largest_sample = 0;         ///< that was really written, full scale; 0 where the output is a device
  std::int64_t onset_frame = 0;
};

/// Of a stream that has played: all but the burst's own (peak, largest sample, onset).
PlayReport report_of(Stream& stream);

/// Plays or renders one burst and the silence around it: in real time for `alsa:`, at once otherwise. The
/// burst's start frame is moved to the soonest possible one. Throws as above.
PlayReport play(const StreamConfig& config, Burst burst);

}  // namespace turnpoint::drive
