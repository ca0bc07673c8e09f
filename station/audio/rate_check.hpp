#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::audio {

/// The rate of a device's clock, measured against CLOCK_MONOTONIC_RAW (which time services do not adjust).
struct MeasuredRate {
  double rate_Hz = 0;
  double deviation_ppm = 0;  ///< deviation from the nominal rate
  double standard_error_ppm = 0;
  double span_s = 0;
};

/// Checks that the device plays frames at the nominal rate. No other check detects a resampler inside the
/// device or a wrong clock. The rate comes from a regression with running sums, which needs constant memory
/// and is safe on the audio thread.
class RateCheck {
 public:
  static constexpr double tolerance_ppm = 200;

  explicit RateCheck(double nominal_rate_Hz) noexcept : nominal_rate_Hz_(nominal_rate_Hz) {}

  void add(std::int64_t frame, std::int64_t raw_ns) noexcept;
  void restart() noexcept { count_ = 0; }

  /// Returns the rate once at least 16 time stamps span 2 s or more and the result is certain: a standard
  /// error of at most 40 ppm, and a deviation clearly inside or outside the tolerance. After 20 s, returns it
  /// in any case.
  std::optional<MeasuredRate> result() const noexcept;

 private:
  double nominal_rate_Hz_;
  std::int64_t first_frame_ = 0, first_ns_ = 0, last_ns_ = 0, last_frame_ = 0;
  double count_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace turnpoint::audio
