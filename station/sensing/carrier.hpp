#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/core/limits.hpp"
#include "station/sensing/capture_block.hpp"
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
  bool ready_ = false;
  std::int64_t output_index_ = 0;
  std::array<std::complex<double>, inputs> output_{};
};

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
  Lanes output_{};
};

/// Bandwidth of the force signal and rate of its points. `force` passes 0 to 400 Hz, stops 600 Hz and above,
/// and gives 1000 points a second. `wide` passes 0 to 1 kHz, stops 2 kHz and above, and gives 4000 points a
/// second. Use `wide` only with a single drive tone, because two tones 1 kHz apart add a false force at 1
/// kHz. Both reject the stopped frequencies by 100 dB.
enum class Band { force, wide };
constexpr int points_per_second(Band band) { return band == Band::force ? 1000 : 4000; }

inline constexpr std::size_t bridge_count = 3;

/// Wiring and calibration of the strain-gauge bridges in three force cells, with a common carrier: the cells
/// a and b below the surface, and the lateral cell.
struct BridgeOptions {
  int rate_Hz = 192000;  ///< sampling rate; must be a multiple of 8000
  double carrier_Hz = core::kForceCarrier_Hz;
  Band band = Band::force;
  int channels = 4;   ///< number of channels in a captured frame
  int reference = 0;  ///< captured channel of the excitation itself
  /// captured channels of cells a and b and of the lateral cell
  std::array<int, bridge_count> bridges{1, 2, 3};
  double reference_amplitude = 0.5;  ///< amplitude of the reference signal at calibration; full scale is 1
  /// Ratio of bridge signal to reference signal at the rated load of each cell.
  std::array<double, bridge_count> full_scale{0.4, 0.4, 0.4};
  /// Phase of each bridge's resistive part against the reference.
  std::array<double, bridge_count> rotation_rad{};
};

/// A reading above this many times the one at the rated load is an overload.
inline constexpr double overload_share = 1.5;

/// The reason why a point must not be used. `none` means that it may be used.
enum class WireFault {
  none,
  reference,   ///< amplitude of the reference more than 3 % off; the ratios are then NaN
  quadrature,  ///< quadrature of a bridge above 5 % of full scale: a wire or a shield is off
  overload,    ///< a bridge above 1.5 times full scale: a wire is off, or the cell is overloaded
  silent,      ///< samples of a bridge have no noise: they do not change at all, or the same ones come again
               ///< and again; its amplifier or converter is dead, or its driver is stuck
};

/// Counts how often a value has been the same in a row.
class Unchanged {
 public:
  /// Returns how many values in a row, including this one, are equal.
  std::int64_t add(double value) noexcept {
    count_ = count_ > 0 && value == last_ ? count_ + 1 : 1;
    last_ = value;
    return count_;
  }
  void reset() noexcept { count_ = 0; }

 private:
  double last_ = 0;
  std::int64_t count_ = 0;
};

/// Finds samples that come again: a converter or driver that is stuck repeats the last block that it has
/// read. With noise in them, so many samples in a row are never the same twice.
class Repeated {
 public:
  /// `enough` samples in a row that are equal to earlier ones count as a repetition, if they come again
  /// within `longest` samples.
  Repeated(std::size_t enough, std::int64_t longest) : kept_(enough), longest_(longest) {}
  /// Returns true if this sample is the last of a row that came before.
  bool add(std::int32_t value) noexcept;
  void reset() noexcept { filled_ = 0; }

 private:
  std::vector<std::int32_t> kept_;  ///< the samples that are expected again
  std::int64_t longest_, age_ = 0;
  std::size_t filled_ = 0, equal_ = 0;
};

/// The signals of the three bridges, divided by the reference signal, at one point in time.
struct BridgePoint {
  std::int64_t index = 0;  ///< point k is exactly at playback frame k * rate / points_per_second()
  /// In-phase and quadrature part of bridge / reference. NaN if a captured frame is missing that the filter
  /// needs for this point.
  std::array<double, bridge_count> ratio{}, quadrature{};
  double reference = 0;  ///< amplitude of the reference signal; full scale is 1
  WireFault fault = WireFault::none;
  std::size_t bridge = 0;  ///< the bridge with the fault `quadrature`, `overload` or `silent`
};

/// Demodulates the bridges with the phase of the played carrier, divides them by the reference, and reduces
/// the result to points_per_second(). The division cancels gain and drift of converters, buffer and
/// excitation. The result does not depend on how the frames are divided into blocks. Point k is complete once
/// frames 17 ms (wide: 4 ms) beyond it have arrived. Not thread-safe; allocates only in the constructor,
/// which throws core::UsageError for impossible options.
class BridgeDemodulator {
 public:
  explicit BridgeDemodulator(const BridgeOptions& options);

  /// Takes captured frames and calls `take` for each complete point. Frames must have the numbers at which
  /// they were played, so subtract the loop delay, rounded to whole frames. Frames that are left out count as
  /// missing; frames that were already received are ignored. Throws std::logic_error if a block's rate or
  /// number of channels differs from the options.
  template <typename Take>
  void push(const CaptureBlock& block, Take&& take) {
    check(block);
    if (!started_) next_frame_ = block.first_frame;
    started_ = true;
    while (next_frame_ < block.first_frame)
      if (add(nullptr, block.first_frame - next_frame_)) take(point_);
    const std::int64_t end = block.first_frame + block.frames();
    while (next_frame_ < end)
      if (add(block.samples.data() + (next_frame_ - block.first_frame) * block.channels, end - next_frame_))
        take(point_);
  }

  /// Number of playback frames from one point to the next.
  int frames_per_point() const { return options_.rate_Hz / points_per_second(options_.band); }

 private:
  void check(const CaptureBlock& block) const;
  /// Takes some of the next `count` frames; a null `frames` means that they are missing. Returns true if a
  /// point is complete.
  bool add(const std::int32_t* frames, std::int64_t count) noexcept;
  void watch(const std::int32_t* frames, std::int64_t count) noexcept;
  void finish_point() noexcept;

  BridgeOptions options_;
  std::array<double, bridge_count> cos_, sin_;
  CarrierFilter first_;
  Decimator second_;
  std::int64_t next_frame_ = 0;
  bool started_ = false;
  std::array<Unchanged, bridge_count> unchanged_;
  std::int64_t longest_block_ = 0;  ///< longest block whose repetition is looked for, in frames
  std::vector<Repeated> repeated_;
  std::array<std::int64_t, bridge_count> silent_until_;  ///< last frame at which the bridge was silent
  BridgePoint point_;
};

}  // namespace turnpoint::sensing
