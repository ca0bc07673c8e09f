#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "station/audio/block_ring.hpp"
#include "station/audio/output.hpp"
#include "station/system/memory_range.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::audio {

/// Some captured frames. The samples are interleaved; full scale is 2^31.
struct CapturedBlock {
  static constexpr int kSamples = 1024;
  /// number of the first frame, counted from 0 when the device was opened; lost frames are counted too
  std::int64_t first_frame = 0;
  /// Changes with each loss of frames. After a change, the delay from played to captured frames must be
  /// measured again, because not every device reports how many frames were lost.
  std::uint32_t numbering = 0;
  std::int32_t count = 0;  ///< number of samples in use
  std::array<std::int32_t, kSamples> samples{};

  std::span<const std::int32_t> used() const noexcept {
    return {samples.data(), static_cast<std::size_t>(count)};
  }
};

/// The blocks that wait between the capture thread and the thread that uses them: 0.7 s for six channels.
using CaptureRing = BlockRing<CapturedBlock, 1024>;

struct CaptureCounters {
  std::int64_t frames = 0;        ///< frames captured or lost so far
  std::int64_t overruns = 0;      ///< gaps for which the device said how many frames were lost
  std::int64_t lost_frames = 0;   ///< frames lost in `overruns`
  std::int64_t unknown_gaps = 0;  ///< losses of an unknown number of frames: the device was restarted or lost
  /// current value of CapturedBlock::numbering, which changes with each loss of frames
  std::uint32_t numbering = 0;
  bool present = true;  ///< false while the device is lost
};

/// Takes captured frames on the capture's own thread as soon as they are there, before they wait in the ring.
class CaptureListener {
 public:
  virtual ~CaptureListener() = default;
  /// Interleaved frames, of which the first has the number `first_frame`; the arguments are those of a
  /// CapturedBlock. It must not allocate, lock, log or wait.
  virtual void captured(std::int64_t first_frame, std::uint32_t numbering,
                        std::span<const std::int32_t> samples) noexcept = 0;
};

/// An open capture device. One thread takes the blocks; any thread may ask for the counters.
class Capture {
 public:
  virtual ~Capture() = default;
  /// Takes the oldest block that has not been taken yet. Returns null if there is none. The block is valid
  /// until the next call. Wait-free.
  [[nodiscard]] virtual const CapturedBlock* take() noexcept = 0;
  /// Calls `listener` with all frames that are captured from now on. It must outlive the capture.
  virtual void listen(CaptureListener& listener) noexcept = 0;
  virtual CaptureCounters counters() const noexcept = 0;
  virtual system::Rights rights() const = 0;
};

struct AlsaDevice;

/// Captures from an ALSA device. The thread that calls step() is the capture side: open_capture() uses a
/// thread of its own, a test may use any.
class DeviceCapture : public Capture {
 public:
  /// `config.uri` must be alsa:NAME, `config.channels` is the number of captured channels. Throws the same
  /// errors as open_output.
  explicit DeviceCapture(const OutputConfig& config);
  ~DeviceCapture() override;

  /// Call this on the capture side. Waits for the next period and puts it into the ring. Does not allocate or
  /// lock, except while it tries to open a lost device again.
  void step() noexcept;

  const CapturedBlock* take() noexcept override { return blocks_->take(); }
  void listen(CaptureListener& listener) noexcept override { listener_.store(&listener); }
  CaptureCounters counters() const noexcept override;
  system::Rights rights() const override { return {}; }

  /// Memory that the capture side uses, so that it can be locked.
  std::vector<system::MemoryRange> memory() const;

 private:
  struct Device;
  void read(std::int64_t available) noexcept;
  void push(std::int64_t frames) noexcept;
  void lose(std::int64_t frames) noexcept;
  void recover(int error) noexcept;
  void absent() noexcept;
  int reopen() noexcept;
  std::int64_t available() noexcept;

  OutputConfig config_;
  std::unique_ptr<Device> device_;
  std::vector<std::int32_t> period_;
  std::unique_ptr<CaptureRing> blocks_ = std::make_unique<CaptureRing>();
  std::atomic<std::int64_t> frames_{0}, overruns_{0}, lost_frames_{0}, unknown_gaps_{0};
  std::atomic<std::uint32_t> numbering_{0};
  std::atomic<bool> present_{true};
  std::atomic<CaptureListener*> listener_{nullptr};
};

/// Opens the capture device and starts its thread, with FIFO priority 69 and locked memory.
std::unique_ptr<Capture> open_capture(const OutputConfig& config);

}  // namespace turnpoint::audio
