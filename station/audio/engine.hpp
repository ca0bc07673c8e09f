#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/audio/amplifier.hpp"
#include "station/audio/burst.hpp"
#include "station/audio/frame_clock.hpp"
#include "station/audio/gain_line.hpp"
#include "station/audio/output.hpp"
#include "station/audio/prepared_burst.hpp"
#include "station/audio/rate_check.hpp"
#include "station/audio/synth.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::audio {

/// A device receives each frame one buffer length before it plays the frame. Therefore the end of a burst is
/// reported twice: by burst_ended when the last frame has been rendered, and by burst_heard when it has been
/// played. If frames of the burst were lost, there is no burst_heard, and the underrun event names the burst.
enum class EventKind : std::int32_t {
  burst_started,  ///< `frame`: first frame of the burst, as scheduled
  /// `frame`: the first silent frame after the burst; if the burst was stopped before it began, its first
  /// frame
  burst_ended,
  /// the burst was played completely and as scheduled; `frame`: the first silent frame after it
  burst_heard,
  /// the command arrived after the burst's first frame had been rendered: the burst is not played
  burst_missed,
  /// the gains that the burst follows were missing from `frame` on: it goes to its resting gain
  burst_unfollowed,
  burst_follows,  ///< from `frame` on the burst follows its gains again
  underrun,       ///< frames [frame, frame + frames) were not played; sounding bursts continue with a ramp
  device_lost,    ///< nothing is played from `frame` on, until the device is back and the operator re-arms
  device_back,    ///< the device was reopened by name; frame numbers continue from `frame`
  /// the measured rate is more than 200 ppm off, so the session must stop; `frames`: the rate in mHz
  rate_wrong,
};

struct Event {
  EventKind kind = EventKind::burst_started;
  /// underrun, device_lost: number of the first burst that lost frames; 0 if none did
  std::uint32_t burst = 0;
  std::int64_t frame = 0;
  std::int64_t frames = 0;
  int error = 0;  ///< negative errno that the device reported; 0 if none
  /// For an underrun: true if the device was restarted, so later frames are played at other times than
  /// predicted. Every burst that had not been heard to its end then counts as damaged, even if no frame of it
  /// was lost.
  bool retimed = false;
};

struct Counters {
  std::int64_t frames = 0;  ///< number of frames rendered
  /// number of frames known to have been played or lost; all losses before this frame have been reported
  std::int64_t heard = 0;
  std::int64_t bursts = 0;  ///< number of bursts that began
  std::int64_t missed = 0;
  std::int64_t underruns = 0;
  std::int64_t lost_frames = 0;  ///< number of frames that were not played because of underruns
  std::int64_t saturated = 0;    ///< number of samples that exceeded the range; anything but 0 is a fault
  std::int64_t device_losses = 0;
  std::int64_t events_dropped = 0;  ///< events lost because nobody called poll()
};

/// What a synchronous stream to `null:` does. With `rendered` it computes the samples, so that they or the
/// time that they take can be measured. With `passed` it computes no samples but reports the same events at
/// the same frames; this is enough for simulated sessions.
enum class Samples : std::int32_t { rendered, passed };

struct StreamConfig {
  OutputConfig output;
  Samples samples = Samples::rendered;
  SynthLimits limits;
  int fifo_priority = 70;
  double converter_delay_s = 0;  ///< group delay of the converter, added to predicted times
  /// How many frames a synchronous stream renders ahead of playback, like the buffer of a device: commands
  /// take effect this many frames later. Real-time streams use their device's buffer.
  std::int64_t virtual_lead_frames = 0;
  /// A tone that is played as long as the stream is open, for example to excite the bridges of force sensors.
  /// Its time t is 0 at frame 0 of the stream, and it never restarts.
  std::optional<Tone> carrier;
  /// The amplifier whose audio_alive() is called after each block that a device accepted; may be null. It
  /// must outlive the stream.
  Amplifier* amplifier = nullptr;
};

/// An accepted burst and the frame at which it begins.
struct Scheduled {
  std::uint32_t burst = 0;
  std::int64_t start_frame = 0;
};

/// A stream that plays silence and, at given frames, bursts. Call all functions from one control thread; none
/// of them waits for the audio thread. Frames are counted from 0 when the stream is opened. The count
/// continues through underruns and when the device is reopened.
class Stream {
 public:
  virtual ~Stream() = default;

  /// Checks and sends a burst. Returns its number (from 1). Throws BurstRefused if a limit is exceeded, the
  /// peaks of overlapping bursts add up to too much, the start frame is already past, or too many bursts are
  /// waiting.
  virtual std::uint32_t schedule(const Burst& burst) = 0;
  /// Sends bursts that were already checked for this stream's format and limits, in the order of their start
  /// frames. If the first one is too late, all of them are delayed by the same number of frames, so that the
  /// intervals between them stay exact. Takes microseconds. If it throws BurstRefused, none of the bursts is
  /// played.
  virtual std::vector<Scheduled> schedule_together(std::span<const PreparedBurst> bursts) = 0;
  /// Checks one burst and sends it like schedule_together. The check can take longer than a buffer lasts (see
  /// prepare).
  Scheduled schedule_soon(const Burst& burst);
  /// Changes a waiting or sounding burst; `at_frame` counts from the start of the burst. Throws BurstRefused.
  virtual void change(std::uint32_t burst, const Change& change) = 0;
  /// Gives gains to a burst that follows them, before its frames are rendered. Any thread may call this, but
  /// only one. Returns false if the audio thread has not taken the last 64. Wait-free.
  [[nodiscard]] virtual bool follow(const GainPeriod& gains) noexcept = 0;
  /// Ramps down the burst with this number (0: all bursts), from the given frame of the stream or, without
  /// one, as soon as possible. Throws std::runtime_error if the audio thread does not accept commands.
  virtual void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame = {}) = 0;

  /// Returns the oldest event that was not returned yet; empty if there is none. Call this at least every few
  /// seconds: it also collects the device's time stamps, of which the audio thread can keep 2048.
  virtual std::optional<Event> poll() = 0;

  /// The earliest start frame at which a burst that is scheduled now will certainly be played.
  virtual std::int64_t earliest_frame() const = 0;
  /// Maps frames to CLOCK_MONOTONIC (for a synchronous stream: to virtual time). The time is not known before
  /// the device has reported its first position, while the device is lost, and just after a restart; the fit
  /// then has no pairs.
  virtual ClockFit clock() = 0;
  /// Predicted time (ns) at which this frame leaves the converter, including the group delay; empty if not
  /// known.
  virtual std::optional<std::int64_t> time_of(std::int64_t frame) = 0;
  virtual std::optional<std::int64_t> frame_at(std::int64_t time_ns) = 0;

  /// Measured rate of the open device's clock; empty for the first 2 s, and for streams without a device.
  virtual std::optional<MeasuredRate> measured_rate() = 0;
  virtual Counters counters() const = 0;
  virtual system::Rights rights() const = 0;
  virtual const StreamConfig& config() const = 0;
};

/// A stream on a virtual clock. It has no thread: the caller advances the frames, as fast as the machine can.
/// Time starts at `origin_ns` and advances by exactly frame / rate.
class SynchronousStream : public Stream {
 public:
  /// Renders and writes this many frames. Throws std::system_error if a file cannot be written.
  virtual void advance(std::int64_t frames) = 0;
  virtual std::int64_t frame() const = 0;     ///< the next frame to render
  virtual std::int64_t now_ns() const = 0;    ///< virtual time of the next frame to render
  virtual double largest_sample() const = 0;  ///< largest sample written so far, relative to full scale
  /// Calls `listener` with each block that is rendered, and with the number of the block's first frame.
  virtual void listen(
      std::function<void(std::int64_t first_frame, std::span<const std::int32_t> interleaved)> listener) = 0;
  /// Completes the output (file headers). Throws std::system_error.
  virtual void finish() = 0;
};

/// Opens a stream on a virtual clock. Throws the errors of open_output. Also throws core::UsageError for a
/// format that cannot be synthesised, and for Samples::passed with an output that needs samples.
std::unique_ptr<SynchronousStream> open_synchronous(const StreamConfig& config, std::int64_t origin_ns = 0);

/// Opens the output and starts the audio thread. The device sets the pace; for `null:` and `wav:`,
/// CLOCK_MONOTONIC does. The destructor ramps down the bursts that are sounding and joins the thread.
std::unique_ptr<Stream> open_realtime(const StreamConfig& config);

struct PlayReport {
  Counters counters;
  system::Rights rights;
  ClockFit clock;
  std::optional<MeasuredRate> rate;  ///< measured clock rate; only for a device that played for 2 s or more
  double peak = 0;                   ///< largest sample, computed before playing, relative to full scale
  /// largest sample written, relative to full scale; 0 if the output is a device
  double largest_sample = 0;
  std::int64_t onset_frame = 0;
};

/// Reports on a stream after playing. Leaves out what only the caller knows about the burst: peak, largest
/// sample, onset.
PlayReport report_of(Stream& stream);

/// Plays or renders one burst and the silence around it: in real time for `alsa:`, as fast as possible
/// otherwise. The burst starts at the earliest possible frame. Throws the errors of opening and scheduling.
PlayReport play(const StreamConfig& config, Burst burst);

}  // namespace turnpoint::audio
