#include "station/sensing/decimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace turnpoint::sensing {

namespace {
// number of samples after which the kept ones are moved to the front of their buffer
constexpr std::size_t kSpareSamples = 128;
}  // namespace

std::vector<double> low_pass(double pass_Hz, double stop_Hz, double rate_Hz, double attenuation_dB) {
  const double transition = 2 * std::numbers::pi * (stop_Hz - pass_Hz) / rate_Hz;
  const double beta = 0.1102 * (attenuation_dB - 8.7);
  const int half = static_cast<int>(std::ceil((attenuation_dB - 7.95) / (2.285 * transition) / 2));
  const double cut_off = (pass_Hz + stop_Hz) / rate_Hz;  // as a fraction of half the sampling rate
  std::vector<double> taps;
  for (int k = -half; k <= half; ++k) {
    const double x = std::numbers::pi * cut_off * k, place = static_cast<double>(k) / (half + 1);
    taps.push_back((k == 0 ? 1 : std::sin(x) / x) *
                   std::cyl_bessel_i(0.0, beta * std::sqrt(1 - place * place)));
  }
  const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
  for (double& tap : taps) tap /= sum;
  return taps;
}

Decimator::Decimator(const std::vector<double>& taps, int factor)
    : half_taps_(taps.begin() + static_cast<std::ptrdiff_t>(taps.size() / 2), taps.end()),
      kept_(taps.size() + kSpareSamples),
      filled_(taps.size()),
      half_(static_cast<std::int64_t>(taps.size() / 2)),
      factor_(factor),
      loops_(&best_loops()) {
  half_taps_.front() /= 2;  // the loop adds the sample in the middle twice
  for (Lanes& sample : kept_) sample.fill(std::numeric_limits<double>::quiet_NaN());
}

bool Decimator::push(std::int64_t index, const Lanes& sample) noexcept {
  if (filled_ == kept_.size()) {
    const auto kept = static_cast<std::size_t>(2 * half_);
    std::copy_n(kept_.end() - static_cast<std::ptrdiff_t>(kept), kept, kept_.begin());
    filled_ = kept;
  }
  kept_[filled_++] = sample;
  const std::int64_t centre = index - half_;
  if (centre % factor_ != 0) return false;
  output_index_ = centre / factor_;
  const Lanes& middle = kept_[filled_ - 1 - static_cast<std::size_t>(half_)];
  loops_->eight(middle.data(), half_, half_taps_.data(), output_.data());
  return true;
}

}  // namespace turnpoint::sensing
