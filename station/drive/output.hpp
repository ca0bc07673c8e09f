#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/drive/memory_range.hpp"
#include "station/drive/prepared_burst.hpp"

namespace turnpoint::drive {

/// Where the drive goes and how. `uri` is `null:`, `wav:FILE` (32-bit PCM) or `alsa:NAME`.
struct OutputConfig {
  std::string uri = "null:";
  int rate_Hz = 192000;
  int channels = 2;
  int bits = 24;
  int period_frames = 384;
  int periods = 4;
  int device_channels = 0;  ///< of an ALSA device that has more than the stream; they carry zeros
  std::vector<std::string> allow_plugin;  ///< alsa-lib plug-in types accepted beside hw (tests)
};

Format format_of(const OutputConfig& config) noexcept;

/// How a write ended. skipped: the device ran past what it had and played silence, and those frames were
/// passed over. restarted: the device had to be started anew, so frames and time have a new relation. lost:
/// the device is gone (reported by every write until it is back). reopened: the device takes frames again.
enum class WriteStatus { ok, skipped, restarted, lost, reopened };

/// Unless `status` is ok, the frames of the block after the first `taken` were not written, and must not be:
/// they belong to a time that has passed. The next frame to write is then `taken + passed` after the block's
/// first.
struct WriteResult {
  WriteStatus status = WriteStatus::ok;
  int error = 0;            ///< negative errno
  std::int64_t taken = 0;   ///< frames of this block that the device took
  std::int64_t passed = 0;  ///< frames after those that pass in silence
  /// Frames up to and including the taken ones that the device was given and (as far as is known) never
  /// played.
  std::int64_t dropped = 0;
};

/// A frame and when it was at the converter.
struct Position {
  std::int64_t frame = 0;
  std::int64_t time_ns = 0;
};

/// One place that takes a stream of interleaved 32-bit frames at an exact rate, opened and configured.
class Output {
 public:
  virtual ~Output() = default;
  virtual const OutputConfig& config() const noexcept = 0;
  /// Writes whole frames; blocks as long as the device does (files and null do not). Comes back at once,
  /// without writing the rest, where frames were lost. Allocates and locks nothing.
  virtual WriteResult write(std::span<const std::int32_t> interleaved) noexcept = 0;
  /// The newest known position, if the device tells; frames count from the first one written.
  virtual std::optional<Position> position() noexcept = 0;
  /// What write() and position() use, to be locked into memory, and what they use beside it, in words. Empty
  /// for files and null.
  virtual std::vector<MemoryRange> memory() const { return {}; }
  virtual std::string memory_left_out() const { return ""; }
  /// Plays what is buffered and closes; throws std::system_error where a file cannot be completed. The
  /// destructor closes as well, silently.
  virtual void finish() = 0;
  /// True where writing takes as long as playing.
  virtual bool paced() const noexcept = 0;
};

/// Opens the output that the URI names; the one place that knows them all.
/// Throws terms::UsageError for an unknown URI, std::system_error or OutputRefused for a device that
/// cannot be opened exactly as asked.
std::unique_ptr<Output> open_output(const OutputConfig& config);

/// A device that would not play the samples as they are: what was asked, and what it offers.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace turnpoint::drive
