#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "station/audio/oscillator.hpp"
#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/sample_loops.hpp"

namespace turnpoint::sensing {

/// A sinusoid that is played. Frame 0 of the partial is played at the absolute frame `origin_frame`. The
/// partial's amplitude is not used. A gliding partial must begin before the first frame for which sums are
/// computed.
struct FollowedTone {
  audio::Partial partial;
  std::int64_t origin_frame = 0;
};

/// Multiplies captured samples by the tones that are played, and sums the products over aligned blocks. For a
/// signal A sin(phase + theta) with the tone's phase, the mean of these products is A e^(i theta) / 2.
///
/// The tone's phase in the middle of a block is computed with the same integers as in the playback, so errors
/// do not grow with time. Within the block, the sines come from a table. Their symmetry about the middle
/// saves half of the work: a tone costs one multiplication per frame and input. Gliding tones cost about 70
/// times as much. Allocates only in its constructor.
class ToneSums {
 public:
  static constexpr std::size_t part_count = 3;  ///< plain(), cosine() and sine()
  enum class Parts {
    plain,    ///< compute only plain()
    windowed  ///< compute also cosine() and sine(), for a Hann window; three times the cost
  };

  /// The Hann window has `window_frames`, a multiple of `block_frames`, which must be even. Captured frame n
  /// contains what was played at frame n - delay.
  ToneSums(std::vector<FollowedTone> tones, std::size_t inputs, int block_frames, int window_frames,
           double delay_frames);

  void compute(const AlignedBlock& block, Parts parts) noexcept;

  /// plain(): sum of sample times i e^(-i phase). cosine() and sine(): the same sum with the additional
  /// factor cos or sin of 2 pi n / window, for the frame n frames after the middle of the block.
  std::complex<double> plain(std::size_t input, std::size_t tone) const noexcept;
  std::complex<double> cosine(std::size_t input, std::size_t tone) const noexcept;
  std::complex<double> sine(std::size_t input, std::size_t tone) const noexcept;

  /// The playback phase of the tone at the time that this captured frame contains, in 2^-64 cycles.
  std::uint64_t phase_at(std::size_t tone, std::int64_t captured_frame) const noexcept;

  std::size_t tones() const noexcept { return tones_.size(); }
  std::uint64_t increment(std::size_t tone) const noexcept { return tones_[tone].partial.increment; }

 private:
  audio::Partial at(std::size_t tone, std::int64_t captured_frame) const noexcept;
  std::uint64_t of_fraction(std::uint64_t increment) const noexcept;
  void fill(std::size_t tone) noexcept;
  void fold(const AlignedBlock& block) noexcept;
  void glide(const AlignedBlock& block, std::size_t tone, const audio::Partial& partial) noexcept;
  std::complex<double> rotated(std::size_t input, std::size_t tone, std::size_t part) const noexcept;
  double* row(std::size_t part, std::size_t parity, std::size_t input) noexcept;
  double factor(std::size_t part, double from_middle) const noexcept;

  std::vector<FollowedTone> tones_;
  std::size_t inputs_;
  int block_frames_, window_frames_;
  std::int64_t delay_;
  double delay_fraction_;
  std::size_t columns_;  ///< number of tones, rounded up to a multiple of kTones
  /// sines of the tones, [part: 1, cos, sin][parity: even, odd][frame after the middle][column]
  std::vector<double> table_;
  std::vector<double>
      folded_;  ///< sums and differences of mirrored frames, [parity][input][frame after the middle]
  std::vector<double> sums_;  ///< results of compute(), [part: 1, cos, sin][parity: even, odd][input][column]
  /// by how much the phase of each tone changes in delay_fraction_ of a frame
  std::vector<std::uint64_t> part_of_frame_;
  std::vector<std::uint64_t> phase_;        ///< phase of each tone in the middle of the block
  std::vector<std::complex<double>> turn_;  ///< e^(i phase) of each tone in the middle of the block
};

/// A tone that was found in noise.
struct FoundTone {
  double frequency_Hz = 0;
  double power = 0;  ///< mean square
};

/// Returns the strongest tone of the samples between two frequencies; empty if no tone stands out of the
/// noise there. Noise that a resonance makes narrow counts as a tone. Takes about 1 ms for 50 ms of samples.
std::optional<FoundTone> strongest_tone(std::span<const double> samples, int rate_Hz, double low_Hz = 0,
                                        double high_Hz = std::numeric_limits<double>::infinity());

}  // namespace turnpoint::sensing
