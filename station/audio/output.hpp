#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/audio/prepared_burst.hpp"
#include "station/system/memory_range.hpp"

namespace turnpoint::audio {

/// The output of the drive and its settings. `uri` is `null:`, `wav:FILE` (32-bit PCM) or `alsa:NAME`.
struct OutputConfig {
  std::string uri = "null:";
  int rate_Hz = 192000;
  int channels = 2;
  int bits = 24;
  int period_frames = 384;
  int periods = 4;
  /// number of channels of the ALSA device, if it has more than the stream; the additional channels carry
  /// zeros
  int device_channels = 0;
  /// types of alsa-lib plug-ins that are accepted besides hw; for tests only
  std::vector<std::string> allow_plugin;
};

Format format_of(const OutputConfig& config) noexcept;

/// How a write ended.
/// skipped: the device ran out of samples and played silence instead of some frames.
/// restarted: the device had to be restarted, so the relation between frames and time has changed.
/// lost: the device is gone (every write reports this until it is back).
/// reopened: the device accepts frames again.
enum class WriteStatus { ok, skipped, restarted, lost, reopened };

/// Unless `status` is ok, only the first `taken` frames of the block were written. Do not write the remaining
/// ones again, because their time has passed. The next frame to write is the block's first plus `taken +
/// passed`.
struct WriteResult {
  WriteStatus status = WriteStatus::ok;
  int error = 0;            ///< negative errno if the write failed
  std::int64_t taken = 0;   ///< number of frames of this block that the device accepted
  std::int64_t passed = 0;  ///< number of frames after the taken ones that were replaced by silence
  /// Number of accepted frames, of this and earlier blocks, that the device has probably never played.
  std::int64_t dropped = 0;
};

/// A frame, and the time at which it reached the converter.
struct Position {
  std::int64_t frame = 0;
  std::int64_t time_ns = 0;
};

/// An open output that takes interleaved 32-bit frames at an exact rate.
class Output {
 public:
  virtual ~Output() = default;
  virtual const OutputConfig& config() const noexcept = 0;
  /// Writes whole frames. Waits for the device if its buffer is full (files and null do not wait). If frames
  /// were lost, returns at once without writing the rest. Does not allocate or lock.
  virtual WriteResult write(std::span<const std::int32_t> interleaved) noexcept = 0;
  /// The newest known position, if the device reports one. Frames are counted from the first one that was
  /// written.
  virtual std::optional<Position> position() noexcept = 0;
  /// memory() returns the memory that write() and position() use, so that it can be locked. memory_left_out()
  /// names further memory that is not in that list. Both are empty for files and null.
  virtual std::vector<system::MemoryRange> memory() const { return {}; }
  virtual std::string memory_left_out() const { return ""; }
  /// Plays what is buffered, then closes. Throws std::system_error if a file cannot be completed. The
  /// destructor closes too, but reports no errors.
  virtual void finish() = 0;
  /// True if writing a block takes as long as playing it.
  virtual bool paced() const noexcept = 0;
};

/// Opens the output of this URI. No other function maps URIs to outputs. Throws core::UsageError for an
/// unknown URI, and std::system_error or OutputRefused for a device that cannot be opened exactly as asked.
std::unique_ptr<Output> open_output(const OutputConfig& config);

/// The device would not play the samples unaltered. The message says what was asked and what the device
/// offers.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Opens an ALSA device by its alsa-lib name (`hw:CARD=DAC,DEV=0`) in such a way that no sample is altered.
/// Throws OutputRefused with what was asked and what the device offers.
std::unique_ptr<Output> open_alsa(const OutputConfig& config, const std::string& name);

/// Opens a RIFF/WAVE file of 32-bit PCM for writing (WAVE_FORMAT_EXTENSIBLE, with the converter's depth as
/// valid bits). Writing fails with an error before the file reaches 4 GiB, the limit of the format. Throws
/// std::system_error if the file cannot be created.
std::unique_ptr<Output> open_wav(const OutputConfig& config, const std::string& path);

}  // namespace turnpoint::audio
