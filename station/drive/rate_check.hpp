#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::drive {

/// The rate of a device's clock, measured against CLOCK_MONOTONIC_RAW (which time services do not adjust).
struct MeasuredRate {
  double rate_Hz = 0;
  double deviation_ppm = 0;  ///< deviation from the nominal rate
  double standard_error_ppm = 0;
  double span_s = 0;
};

/// Checks that the device plays frames at the promised rate. This is the only check that detects a resampler
/// inside a device or a wrong clock. It is a regression with running sums: constant memory, safe for the
/// audio thread.
class RateCheck {
 public:
  static constexpr double tolerance_ppm = 200;

  explicit RateCheck(double nominal_rate_Hz) noexcept : nominal_rate_Hz_(nominal_rate_Hz) {}

  void add(std::int64_t frame, std::int64_t raw_ns) noexcept;
  void restart() noexcept { count_ = 0; }

  /// The rate, once the data span at least 2 s and the standard error is at most 40 ppm (or the data span 20
  /// s).
  std::optional<MeasuredRate> result() const noexcept;

 private:
  double nominal_rate_Hz_;
  std::int64_t first_frame_ = 0, first_ns_ = 0, last_ns_ = 0, last_frame_ = 0;
  double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace turnpoint::drive
