#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

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
  std::vector<std::string> allow_plugin;  ///< alsa-lib plug-in types accepted beside hw (tests)
};

Format format_of(const OutputConfig& config) noexcept;

/// How a write ended. skipped: the device ran on in silence and the lost frames were passed over. restarted:
/// it had to be started anew, so frames and time have a new relation. lost: the device is gone (said at every
/// write until it is back). reopened: it takes frames again.
enum class WriteStatus { ok, skipped, restarted, lost, reopened };
struct WriteResult {
  WriteStatus status = WriteStatus::ok;
  int error = 0;                 ///< negative errno
  std::int64_t lost_frames = 0;  ///< that passed in silence
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
  /// Writes whole frames; blocks as long as the device does (files and null do not). Allocates and locks
  /// nothing.
  virtual WriteResult write(std::span<const std::int32_t> interleaved) noexcept = 0;
  /// The newest known position, if the device tells; frames count from the first one written.
  virtual std::optional<Position> position() noexcept = 0;
  /// Plays what is buffered and closes; throws std::system_error where a file cannot be completed. The
  /// destructor closes as well, silently.
  virtual void finish() = 0;
  /// True where writing takes as long as playing.
  virtual bool paced() const noexcept = 0;
};

/// Opens the output that the URI names; the one place that knows them all.
/// Throws std::invalid_argument for an unknown URI, std::system_error or OutputRefused for a device that
/// cannot be opened exactly as asked.
std::unique_ptr<Output> open_output(const OutputConfig& config);

/// A device that would not play the samples as they are: what was asked, and what it offers.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace turnpoint::drive
