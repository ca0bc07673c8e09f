#include "station/audio/rate_check.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::audio {

// Linear regression of y on x. x is the time on the raw clock in seconds. y is the number of frames played
// minus the number at the nominal rate; using this difference keeps the sums small.
void RateCheck::add(std::int64_t frame, std::int64_t raw_ns) noexcept {
  if (count_ == 0 || frame < last_frame_ || raw_ns < last_ns_) {
    first_frame_ = frame;
    first_ns_ = raw_ns;
    count_ = x_ = y_ = xx_ = xy_ = yy_ = 0;
  }
  last_frame_ = frame;
  last_ns_ = raw_ns;
  const double x = static_cast<double>(raw_ns - first_ns_) * 1e-9;
  const double y = static_cast<double>(frame - first_frame_) - x * nominal_rate_Hz_;
  count_ += 1;
  x_ += x;
  y_ += y;
  xx_ += x * x;
  xy_ += x * y;
  yy_ += y * y;
}

std::optional<MeasuredRate> RateCheck::result() const noexcept {
  const double span = count_ > 0 ? static_cast<double>(last_ns_ - first_ns_) * 1e-9 : 0;
  if (count_ < 16 || span < 2) return std::nullopt;
  const double sxx = xx_ - x_ * x_ / count_, sxy = xy_ - x_ * y_ / count_, syy = yy_ - y_ * y_ / count_;
  if (!(sxx > 0)) return std::nullopt;
  const double slope = sxy / sxx;
  const double variance = std::max(0.0, syy - slope * sxy) / (count_ - 2);
  MeasuredRate rate;
  rate.rate_Hz = nominal_rate_Hz_ + slope;
  rate.deviation_ppm = slope / nominal_rate_Hz_ * 1e6;
  rate.standard_error_ppm = std::sqrt(variance / sxx) / nominal_rate_Hz_ * 1e6;
  rate.span_s = span;
  // Coarse time stamps have correlated errors, so the computed standard error is too small. Therefore, in the
  // first 20 s, report a wrong rate only if it is far off.
  const double off = std::abs(rate.deviation_ppm);
  const bool clear = off <= tolerance_ppm || off > tolerance_ppm + 4 * rate.standard_error_ppm;
  if ((rate.standard_error_ppm > 40 || !clear) && span < 20) return std::nullopt;
  return rate;
}

}  // namespace turnpoint::audio
