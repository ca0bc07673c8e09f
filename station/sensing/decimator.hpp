#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/sensing/sample_loops.hpp"

namespace turnpoint::sensing {

/// Designs a linear-phase low-pass filter of odd length by the window method: an ideal low-pass with its edge
/// in the middle between pass_Hz and stop_Hz, times a Kaiser window (Kaiser 1974). The gain at 0 Hz is
/// exactly 1. Ripple and stop band are `attenuation_dB` below this gain (60 dB or more).
std::vector<double> low_pass(double pass_Hz, double stop_Hz, double rate_Hz, double attenuation_dB);

/// Filters eight signals at once and keeps every `factor`-th result. Each sample has an index, and output m
/// is centred on the index m * factor, so the filter causes no delay. An output is NaN if a sample that
/// contributes to it is NaN or came before the first sample. Allocates only in the constructor.
class Decimator {
 public:
  static constexpr std::size_t lanes = 8;
  using Lanes = std::array<double, lanes>;

  /// `taps` must be symmetric, and their number odd.
  Decimator(const std::vector<double>& taps, int factor);

  /// Takes the sample with this index, which must be one more than that of the previous sample. Returns true
  /// if it completes an output.
  bool push(std::int64_t index, const Lanes& sample) noexcept;
  const Lanes& output() const noexcept { return output_; }
  std::int64_t output_index() const noexcept { return output_index_; }

 private:
  std::vector<double> half_taps_;  ///< the taps from the middle on; the first is halved
  std::vector<Lanes> kept_;        ///< the most recent samples, the newest last
  std::size_t filled_;
  std::int64_t half_, factor_, output_index_ = 0;
  const SampleLoops* loops_;
  Lanes output_{};
};

}  // namespace turnpoint::sensing
