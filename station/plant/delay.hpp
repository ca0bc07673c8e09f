#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace turnpoint::plant {

/// The recent past of one playback channel, read with a delay in whole frames and a fixed fraction. Without a
/// fraction the samples come back bit by bit; with one, by a windowed sinc of 48 samples, to 1e-4 of a tone
/// below 0.25 of the rate.
class Delay {
 public:
  static constexpr int kTaps = 48;
  static constexpr int kLeast = kTaps / 2;  ///< least whole delay with a fraction

  /// `longest`: the longest delay in frames that will be read. `fraction` is in [0, 1).
  Delay(std::int64_t longest, double fraction);

  void push(double sample) { samples_[static_cast<std::size_t>(++newest_ & mask_)] = sample; }
  /// The sample `frames` before the newest one, plus the fraction. Zero before the first one.
  double read(std::int64_t frames) const {
    if (taps_.empty()) return whole(frames);
    double sum = 0;
    for (int k = 0; k < kTaps; ++k)
      sum += taps_[static_cast<std::size_t>(k)] * whole(frames - kLeast + 1 + k);
    return sum;
  }
  /// The same without the fraction.
  double whole(std::int64_t frames) const {
    return samples_[static_cast<std::size_t>((newest_ - frames) & mask_)];
  }

 private:
  std::vector<double> samples_;
  std::int64_t mask_;
  std::int64_t newest_ = -1;
  std::vector<double> taps_;
};

}  // namespace turnpoint::plant
