#pragma once
#include <complex>
#include <cstdint>
#include <vector>

#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/interval_result.hpp"
#include "station/sensing/joint_fit.hpp"
#include "station/sensing/pick_up.hpp"
#include "station/sensing/planned_lines.hpp"

namespace turnpoint::sensing {

/// The tone at a frame counted from the first frame of its glide of `frames` frames. Before and after the
/// glide its frequency is constant.
audio::Partial tone_at(const PlayedTone& tone, std::int64_t frames, std::int64_t frame) noexcept;

/// What a pick-up captures of a tone that glides. A tone that passes a resonance in a few milliseconds is
/// neither as strong nor as late as a steady tone of the same frequency. So the tone is filtered with the
/// pick-up's calibrated response, in the frequency domain, at a reduced sampling rate.
class GlideResponse {
 public:
  /// Computes the response until `tail_frames` after the end of the glide.
  GlideResponse(const Glide& glide, const PlayedTone& tone, const PickUp& pick_up, int rate_Hz,
                std::int64_t tail_frames);

  /// False if the calibration does not cover the whole glide; at() is then 0.
  bool calibrated() const noexcept { return !values_.empty(); }
  /// The captured complex amplitude relative to the phase with which the tone is played, at this frame
  /// (counted from the glide's first frame; may have a fraction) and without the loop delay.
  std::complex<double> at(double frame) const noexcept;

 private:
  std::int64_t lead_ = 0, step_ = 1;  ///< value k belongs to frame k * step_ - lead_
  std::vector<std::complex<double>> values_;
};

/// Measures the tones of one glide. What a pick-up should capture of each tone is computed for the whole
/// glide (GlideResponse). In windows of about 5 ms, all tones together are fitted by least squares to the
/// captured samples; the result is, for each tone, the captured amplitude relative to the computed one.
/// Nothing is said about vibration that the tones do not explain: a plate that a finger loads, or that is a
/// little warmer, leaves such a rest in a glide, because its resonances are not where they were calibrated.
///
/// A tone is judged only while it has at least a tenth of the amplitude of the strongest tone, so a tone that
/// fades in or out is judged in a part of the glide.
class GlideProof {
 public:
  /// The captured frames to be measured are [first_frame, end_frame), both multiples of `block_frames`.
  GlideProof(const Glide& glide, std::int64_t first_frame, std::int64_t end_frame,
             const std::vector<PickUp>& pick_ups, int rate_Hz, int block_frames, double delay_frames);

  std::int64_t end_frame() const noexcept { return end_; }
  /// Takes the aligned blocks of the pick-ups, in order. Ignores those that it does not need.
  void take(const AlignedBlock& block);
  /// Drops all windows that extend beyond this captured frame.
  void end_at(std::int64_t frame) noexcept;
  /// True if there were frames to be measured, but none of the windows was complete.
  bool failed() const noexcept;
  /// The tones of the glide. `unseen_dB`: see ProofLimits.
  std::vector<GlideToneProof> result(double unseen_dB) const;

 private:
  /// All tones that have the same frequency throughout the glide. Only their sum can be measured.
  struct Line {
    std::vector<PlayedTone> tones;
    std::vector<std::complex<double>> turns;            ///< e^(i phase) of each tone relative to the first
    std::vector<std::vector<GlideResponse>> responses;  ///< [pick-up][tone]
    std::vector<double> best;  ///< each pick-up's largest response; 0 if it is not calibrated for this line
  };
  struct Fit {
    std::complex<double> ratio;  ///< captured amplitude relative to the computed amplitude
    bool fitted = false;
    double error = 1;  ///< standard error of the ratio
    double seen = 0;   ///< response in this window, as a fraction of the pick-up's largest response
  };
  struct Window {
    std::int64_t first = 0, end = 0;
    bool valid = false;
    std::vector<Fit> fits;  ///< [pick-up][line]
  };

  void add_lines(const std::vector<PickUp>& pick_ups, std::int64_t tail_frames);
  std::vector<std::size_t> strong_lines(std::size_t pick_up) const;
  double product(std::size_t pick_up, std::size_t i, std::size_t j) const noexcept;
  void fill_waves(const AlignedBlock& block) noexcept;
  void fill_columns(std::size_t pick_up, const AlignedBlock& block) noexcept;
  void add_products(std::size_t pick_up, const AlignedBlock& block) noexcept;
  void fit(std::size_t pick_up, Window& window);
  const Fit* best_fit(const Window& window, std::size_t line, double unseen_dB) const noexcept;

  Glide glide_;
  int rate_Hz_, block_frames_;
  std::int64_t delay_;
  double delay_fraction_;
  std::int64_t end_;
  std::size_t pick_ups_;
  std::vector<Line> lines_;
  std::vector<Window> windows_;
  std::size_t current_ = 0;
  std::int64_t summed_ = 0;
  std::vector<std::complex<double>> waves_;  ///< e^(i phase) times the filter's gain, [line][frame of block]
  std::vector<double> columns_;  ///< what is expected, [line][in phase, quarter cycle ahead][frame of block]
  // sums over the window: squares of the planned amplitudes, [line]; products of columns, [pick-up]; products
  // of columns and samples, [pick-up]; squares of the samples, [pick-up]
  std::vector<double> planned_, gram_, right_, energy_;
  JointFit joint_;
};

}  // namespace turnpoint::sensing
