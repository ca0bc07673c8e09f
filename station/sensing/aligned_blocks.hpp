#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/sensing/capture_block.hpp"
#include "station/sensing/sample_loops.hpp"

namespace turnpoint::sensing {

/// A block of captured frames of the chosen channels (inputs), one row per input.
struct AlignedBlock {
  std::int64_t first_frame = 0;
  std::int64_t frames = 0;
  bool lost = false;                   ///< true if some of the frames are missing
  double largest = 0;                  ///< largest absolute sample of all inputs, before the filter
  const double* const* row = nullptr;  ///< row[i][n]: frame n of input i
  const double* energy = nullptr;      ///< energy[i]: sum of the squares of row i
};

/// Cuts captured blocks of any size into blocks of one size, whose first frames are multiples of that size.
/// Results computed from these blocks therefore do not depend on how the samples arrived. Allocates only in
/// its constructor.
class AlignedBlocks {
 public:
  /// `inputs` are the captured channels to use. With a step d > 0 (in frames), a symmetric filter removes low
  /// frequencies (mains hum, friction noise) from the samples s: y(n) = (2 s(n) - s(n-d) - s(n+d)) / 4, see
  /// high_pass_gain().
  AlignedBlocks(int rate_Hz, int channels, std::vector<int> inputs, int block_frames, int high_pass_step);
  AlignedBlocks(const AlignedBlocks&) = delete;
  AlignedBlocks& operator=(const AlignedBlocks&) = delete;

  /// Calls `sink(const AlignedBlock&)` for each complete block. Ignores frames that it has already received.
  /// Throws std::logic_error if a block's rate or number of channels differs from that given to the
  /// constructor.
  template <class Sink>
  void push(const CaptureBlock& block, Sink&& sink) {
    check(block);
    if (!started_) start_at(block.first_frame);
    for (std::int64_t lost = block.first_frame - next_; lost > 0; lost = block.first_frame - next_) {
      take_lost(lost);
      if (full()) sink(finish());
    }
    for (std::int64_t at = next_ - block.first_frame; at < block.frames(); at = next_ - block.first_frame) {
      take(block, at);
      if (full()) sink(finish());
    }
  }

  int block_frames() const noexcept { return block_frames_; }

 private:
  void check(const CaptureBlock& block) const;
  void start_at(std::int64_t frame) noexcept;
  void take_lost(std::int64_t frames) noexcept;
  void take(const CaptureBlock& block, std::int64_t at) noexcept;
  bool full() const noexcept { return filled_ == capacity_; }
  const AlignedBlock& finish() noexcept;

  int rate_Hz_, channels_, block_frames_, step_;
  std::vector<int> inputs_;
  std::int64_t capacity_;  ///< frames of one block, plus the filter's margins on both sides
  std::int64_t filled_ = 0;
  std::int64_t next_ = 0;  ///< number of the next frame to receive
  bool started_ = false;
  std::vector<std::vector<double>> raw_, filtered_;
  std::vector<const double*> rows_;
  std::vector<double> energies_;
  AlignedBlock block_;
};

/// Gain (0 to 1) of the high-pass filter in AlignedBlocks at this frequency; `step` is the filter's step in
/// frames. The filter does not change the phase.
double high_pass_gain(double frequency_Hz, int rate_Hz, int step) noexcept;

/// Returns the filter step (in frames) whose largest gain is at 48 kHz, or as near to 48 kHz as the sampling
/// rate allows.
int high_pass_step(int rate_Hz) noexcept;

}  // namespace turnpoint::sensing
