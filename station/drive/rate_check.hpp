#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::drive {

/// What a device's own clock runs at, against CLOCK_MONOTONIC_RAW (which no time service steers).
struct MeasuredRate {
  double rate_Hz = 0;
  double deviation_ppm = 0;  ///< from the nominal rate
  double standard_error_ppm = 0;
  double span_s = 0;
};

/// Tells whether frames pass at the rate that was promised: a resampler behind a device, or a wrong clock,
/// shows here and nowhere else. Regression with running sums: constant memory, fit for the audio thread.
class RateCheck {
 public:
  static constexpr double tolerance_ppm = 200;

  explicit RateCheck(double nominal_rate_Hz) noexcept : nominal_rate_Hz_(nominal_rate_Hz) {}

  void add(std::int64_t frame, std::int64_t raw_ns) noexcept;
  void restart() noexcept { count_ = 0; }

  /// The rate, once at least 2 s have been seen and its standard error is 40 ppm or less (or 20 s have been
  /// seen).
  std::optional<MeasuredRate> result() const noexcept;

 private:
  double nominal_rate_Hz_;
  std::int64_t first_frame_ = 0, first_ns_ = 0, last_ns_ = 0, last_frame_ = 0;
  double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace turnpoint::drive
