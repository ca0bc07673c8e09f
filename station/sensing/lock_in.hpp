#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

/// Combines sums over blocks into points of a lock-in amplifier with a Hann window. Both LockIn and
/// IntervalProof use this class.
class HannWindow {
 public:
  HannWindow(std::size_t tones, std::size_t inputs, int block_frames, int window_frames);

  /// Takes the sums of the next block (computed with Parts::windowed). Returns true if a point is complete.
  bool take(const AlignedBlock& block, const ToneSums& sums) noexcept;

  /// The captured frame at the centre of the newest point's window.
  std::int64_t centre() const noexcept { return centre_; }

  /// Complex amplitudes [input][tone] of the newest point; NaN if its window contains lost frames.
  std::span<const std::complex<double>> values() const noexcept { return values_; }

 private:
  std::size_t count_;   ///< number of inputs times number of tones
  std::size_t blocks_;  ///< number of blocks in a window
  int block_frames_, window_frames_;
  std::size_t newest_ = 0;
  std::size_t taken_ = 0;
  std::int64_t centre_ = 0;
  std::int64_t expected_ = 0;  ///< number of the first frame of the next block
  /// sums of the newest blocks, [block][part: plain, cosine, sine][input][tone]
  std::vector<std::complex<double>> kept_;
  std::vector<std::complex<double>>
      angle_;  ///< angle_[k]: e^(i 2 pi n / window), n is the middle frame of block k
  std::vector<std::complex<double>> values_;
};

/// Distance between the points of a lock-in amplifier, and length of its window, in frames.
struct LockInShape {
  int block_frames = 192;    ///< distance from one point to the next: 1 ms at 192 kHz
  int window_frames = 1920;  ///< length of the window: 10 ms at 192 kHz

  /// The shape with a point every 1 ms and a window of 10 ms.
  static LockInShape of_rate(int rate_Hz) noexcept;
};

/// A lock-in amplifier: computes the complex amplitude of each played tone in each input, z = 2 LPF{ s i
/// e^(-i phase) }, where s are the samples and LPF is a low-pass filter. A signal A sin(phase + theta) gives
/// A e^(i theta). The phase is that of the playback (audio::Partial), also while a tone glides.
///
/// The low-pass filter is a Hann window: linear phase and an odd number of taps (1919 at 192 kHz). A point
/// belongs to the centre of its window, so the filter causes no delay. A neighbouring tone at a distance of
/// 1.05 kHz leaks in with 6e-4 of its amplitude. The points do not depend on the sizes of the captured
/// blocks. Allocates only in its constructor.
class LockIn {
 public:
  /// `inputs` are the captured channels; captured frame n carries what was played at frame n - delay.
  LockIn(int rate_Hz, int channels, std::vector<int> inputs, std::vector<FollowedTone> tones,
         double delay_frames);
  LockIn(int rate_Hz, int channels, std::vector<int> inputs, std::vector<FollowedTone> tones,
         double delay_frames, const LockInShape& shape);

  /// Calls `sink(double playback_frame, std::span<const std::complex<double>> values)` for each new point.
  /// The values are in units of full scale, in the order [input][tone], and NaN if the window contains lost
  /// frames. Throws std::logic_error if a block's rate or number of channels differs from that given to the
  /// constructor.
  template <class Sink>
  void push(const CaptureBlock& block, Sink&& sink) {
    blocks_.push(block, [&](const AlignedBlock& aligned) {
      sums_.compute(aligned, ToneSums::Parts::windowed);
      if (window_.take(aligned, sums_))
        sink(static_cast<double>(window_.centre()) - delay_, window_.values());
    });
  }

 private:
  AlignedBlocks blocks_;
  ToneSums sums_;
  HannWindow window_;
  double delay_;
};

}  // namespace turnpoint::sensing
