#include "station/sensing/decimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace turnpoint::sensing {

namespace {
/// Two numbers in one vector register; every 64-bit processor has such registers.
using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
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

Decimator::Decimator(std::vector<double> taps, int factor)
    : taps_(std::move(taps)),
      ring_(taps_.size()),
      half_(static_cast<std::int64_t>(taps_.size() / 2)),
      factor_(factor) {
  for (Lanes& sample : ring_) sample.fill(std::numeric_limits<double>::quiet_NaN());
}

bool Decimator::push(std::int64_t index, const Lanes& sample) noexcept {
  newest_ = newest_ + 1 == ring_.size() ? 0 : newest_ + 1;
  ring_[newest_] = sample;
  const std::int64_t centre = index - half_;
  if (centre % factor_ != 0) return false;
  output_index_ = centre / factor_;
  // The filter is symmetric, so samples and taps need not be in the same order of time.
  const std::size_t first_part = ring_.size() - (newest_ + 1);
  double sum[lanes] = {};
  const auto add = [&](const Lanes* in, const double* tap, std::size_t count) {
    Pair local[lanes / 2];
    for (std::size_t k = 0; k < lanes / 2; ++k) local[k] = Pair{sum[2 * k], sum[2 * k + 1]};
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < lanes / 2; ++k) local[k] += Pair{in[i][2 * k], in[i][2 * k + 1]} * tap[i];
    for (std::size_t k = 0; k < lanes; ++k) sum[k] = local[k / 2][k % 2];
  };
  add(ring_.data() + newest_ + 1, taps_.data(), first_part);
  add(ring_.data(), taps_.data() + first_part, ring_.size() - first_part);
  std::copy_n(sum, lanes, output_.begin());
  return true;
}

}  // namespace turnpoint::sensing
