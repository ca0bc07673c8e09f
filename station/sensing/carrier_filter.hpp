#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/sensing/sample_loops.hpp"

namespace turnpoint::sensing {

/// Mixes four captured channels s down from a carrier, filters them with the taps h, and keeps every
/// `factor`-th result: z = 2 sum h(n) s e^(-i phase), where full scale is 1 and phase is the carrier's phase
/// at the frame's absolute number. The taps include the carrier; their symmetry saves half of the
/// multiplications. Output m is centred on frame m * factor, so the filter causes no delay. An output is NaN
/// if a frame that contributes to it is missing or came before the first frame. Allocates only in the
/// constructor.
class CarrierFilter {
 public:
  static constexpr std::size_t inputs = 4;

  /// `taps` belong to a low-pass filter of odd length. `channels` are the channels to use; a captured frame
  /// has `stride` channels. `increment` is the carrier's phase per frame in 2^-64 cycles.
  CarrierFilter(const std::vector<double>& taps, int factor, std::uint64_t increment,
                const std::array<int, inputs>& channels, int stride);

  /// Takes frames, of which the first has the number `first`, until an output is complete or all are taken. A
  /// null `frames` means that these frames are missing. Returns how many were taken. Frame numbers must
  /// continue from the previous call.
  std::int64_t take(std::int64_t first, const std::int32_t* frames, std::int64_t count) noexcept;

  bool ready() const noexcept { return ready_; }  ///< true if the last take() completed an output
  std::int64_t output_index() const noexcept { return output_index_; }
  const std::array<std::complex<double>, inputs>& output() const noexcept { return output_; }

 private:
  /// The four inputs of a frame, or one filter tap (coefficient) for each of them. Single precision holds the
  /// 24 bits of a converter, and adds noise of -138 dB (rms).
  struct alignas(16) Quad {
    float value[inputs];
  };

  void append(const std::int32_t* frames, std::int64_t count) noexcept;
  void finish(std::int64_t centre) noexcept;

  std::int64_t half_, factor_;
  std::uint64_t increment_;
  std::array<int, inputs> channels_;
  std::int64_t stride_;
  std::vector<Quad> even_, odd_;  ///< filter taps times cosine (even_) or sine (odd_) of the carrier
  std::vector<Quad> kept_;        ///< the most recent frames, the newest last
  std::size_t filled_ = 0;
  const SampleLoops* loops_;
  bool ready_ = false;
  std::int64_t output_index_ = 0;
  std::array<std::complex<double>, inputs> output_{};
};

}  // namespace turnpoint::sensing
