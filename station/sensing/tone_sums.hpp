#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "station/drive/oscillator.hpp"
#include "station/sensing/aligned_blocks.hpp"

namespace turnpoint::sensing {

/// A sinusoid of the playback: frame 0 of the partial is played at the absolute frame `origin_frame`. Its
/// amplitude is not used. A partial that glides must begin before the first frame that is asked for.
struct FollowedTone {
  drive::Partial partial;
  std::int64_t origin_frame = 0;
};

/// Sums of captured samples over aligned blocks, each multiplied by a tone of the playback. A signal
/// A sin(phase + theta) with the tone's phase has the mean product A e^(i theta) / 2.
///
/// The tone's phase in the middle of a block is the playback's own integer, so no error grows with time.
/// Within the block a table of sines is used. Their symmetry about the middle saves half of the work: a tone
/// costs one multiplication per frame and input. Gliding tones cost about 70 times as much. Allocates only in
/// its constructor.
class ToneSums {
 public:
  enum class Parts {
    plain,    ///< only plain()
    windowed  ///< also cosine() and sine(), from which a Hann window is composed; three times the cost
  };

  /// The window has `window_frames`, a multiple of `block_frames`, which is even. Captured frame n carries
  /// what was played at frame n - delay.
  ToneSums(std::vector<FollowedTone> tones, std::size_t inputs, int block_frames, int window_frames,
           double delay_frames);

  void compute(const AlignedBlock& block, Parts parts) noexcept;

  /// Sum of sample times i e^(-i phase), and of the same with the factor cos or sin (2 pi n / window) for
  /// the frame n frames after the middle of the block.
  std::complex<double> plain(std::size_t input, std::size_t tone) const noexcept;
  std::complex<double> cosine(std::size_t input, std::size_t tone) const noexcept;
  std::complex<double> sine(std::size_t input, std::size_t tone) const noexcept;

  /// The tone's phase in what is captured at frame n, in 2^-64 cycles.
  std::uint64_t phase_at(std::size_t tone, std::int64_t captured_frame) const noexcept;

  std::size_t tones() const noexcept { return tones_.size(); }
  std::uint64_t increment(std::size_t tone) const noexcept { return tones_[tone].partial.increment; }

 private:
  drive::Partial at(std::size_t tone, std::int64_t captured_frame) const noexcept;
  std::uint64_t of_fraction(std::uint64_t increment) const noexcept;
  void fill(std::size_t tone) noexcept;
  void fold(const AlignedBlock& block) noexcept;
  void glide(const AlignedBlock& block, std::size_t tone, const drive::Partial& partial) noexcept;
  std::complex<double> rotated(std::size_t input, std::size_t tone, std::size_t part) const noexcept;
  double* row(std::size_t part, std::size_t parity, std::size_t input) noexcept;
  double factor(std::size_t part, double from_middle) const noexcept;

  std::vector<FollowedTone> tones_;
  std::size_t inputs_;
  int block_frames_, window_frames_;
  std::int64_t delay_;
  double delay_fraction_;
  std::size_t columns_;        ///< one per tone, rounded up to a multiple of the loops' width
  std::vector<double> table_;  ///< [part][parity][frame after the middle][column]
  std::vector<double>
      folded_;  ///< [parity][input][frame after the middle]: sum and difference of mirrored frames
  std::vector<double> sums_;                  ///< [part][parity][input][column]
  std::vector<std::uint64_t> part_of_frame_;  ///< phase of each tone for the fraction of the delay
  std::vector<std::uint64_t> phase_;          ///< in the middle of the block
  std::vector<std::complex<double>> turn_;    ///< e^(i phase) in the middle of the block
};

}  // namespace turnpoint::sensing
