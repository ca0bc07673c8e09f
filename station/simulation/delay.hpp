#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace turnpoint::simulation {

/// The recent samples of one playback channel, read with a delay of whole frames plus a constant fraction.
/// Without a fraction the samples are exact. With a fraction, a windowed sinc of 48 samples interpolates
/// them; its error is 1e-4 of a tone below 0.25 of the rate.
class Delay {
 public:
  static constexpr int kTaps = 48;
  /// least number of whole frames in a delay that also has a fraction
  static constexpr int kLeast = kTaps / 2;

  /// `longest` is the longest delay that will be read, in frames. `fraction` is in [0, 1).
  Delay(std::int64_t longest, double fraction);

  void push(double sample) { samples_[static_cast<std::size_t>(++newest_ & mask_)] = sample; }
  /// Returns the sample that came `frames` plus the fraction before the newest one; 0 before the first
  /// sample.
  double read(std::int64_t frames) const {
    if (taps_.empty()) return whole(frames);
    double sum = 0;
    for (int k = 0; k < kTaps; ++k)
      sum += taps_[static_cast<std::size_t>(k)] * whole(frames - kLeast + 1 + k);
    return sum;
  }
  /// Returns the sample that came `frames` whole frames before the newest one.
  double whole(std::int64_t frames) const {
    return samples_[static_cast<std::size_t>((newest_ - frames) & mask_)];
  }

 private:
  std::vector<double> samples_;
  std::int64_t mask_;
  std::int64_t newest_ = -1;
  std::vector<double> taps_;
};

}  // namespace turnpoint::simulation
