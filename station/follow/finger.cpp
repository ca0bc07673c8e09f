#include "station/follow/finger.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "station/follow/need.hpp"

namespace turnpoint::follow {
namespace {

constexpr double reference_tolerance = 0.03, overload_share = 1.5;
constexpr double quadrature_share = 0.05;  // of full scale, as in sensing/carrier.cpp
constexpr int most_unchanged = 32;         // samples with noise are never the same that often in a row
constexpr double beyond_m = 3e-3, jump_m = 8e-3, start_speed_m_s = 0.2;
constexpr int most_jumps = 8;

}  // namespace

const char* name(Fault fault) noexcept {
  constexpr std::array<const char*, kFaults> names{"none",   "late",     "reference", "force",
                                                   "lifted", "position", "saturated"};
  return names[static_cast<std::size_t>(fault)];
}

BridgeWindow::BridgeWindow(const Bridges& bridges, const Timing& timing, std::span<const double> drive_Hz)
    : bridges_(bridges), window_frames_(timing.window_frames) {
  const int n = window_frames_;
  need(timing.rate_Hz > 0, "the rate must be above 0");
  need(n >= 32 && n <= kMostFrames, "the window of the bridges must have 32 to 1024 frames");
  for (const int channel : {bridges.reference, bridges.bridges[0], bridges.bridges[1], bridges.bridges[2]})
    need(channel >= 0 && channel < bridges.channels, "a channel of the bridges does not exist");
  const double cycles = bridges.carrier_Hz * n / timing.rate_Hz;
  need(cycles >= 4 && cycles <= 0.5 * n - 4, "the carrier is too near to 0 or to half the rate");
  for (const double tone_Hz : drive_Hz)
    need(std::abs(tone_Hz - bridges.carrier_Hz) * n >= 4.0 * timing.rate_Hz,
         "a tone of the drive is nearer to the carrier than 4 / window");
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * (i + 0.5) / n;
    const double w = 0.35875 - 0.48829 * std::cos(u) + 0.14128 * std::cos(2 * u) - 0.01168 * std::cos(3 * u);
    const double phase = 2 * std::numbers::pi * cycles * i / n;
    cosine_[static_cast<std::size_t>(i)] = static_cast<float>(w * std::cos(phase));
    sine_[static_cast<std::size_t>(i)] = static_cast<float>(w * std::sin(phase));
    sum += w;
  }
  for (auto* taps : {&cosine_, &sine_})
    for (float& tap : *taps) tap *= static_cast<float>(2 / sum);
}

void BridgeWindow::push(std::int64_t first, const std::int32_t* frames, int count) noexcept {
  if (first != end_) filled_ = next_ = 0, unchanged_.fill(0), repeated_ = 0;
  const int n = window_frames_;
  bool again = count <= filled_;  // every frame so far was that of the push before
  for (int f = 0; f < count; ++f) {
    const std::int32_t* frame = frames + static_cast<std::ptrdiff_t>(f) * bridges_.channels;
    const auto at = static_cast<std::size_t>(next_);
    const auto before = kept_[static_cast<std::size_t>(next_ >= count ? next_ - count : next_ - count + n) %
                              static_cast<std::size_t>(n)];
    kept_[at][0] = static_cast<float>(frame[bridges_.reference]) * 0x1p-31f;
    for (std::size_t b = 0; b < 3; ++b) {
      const std::int32_t value = frame[bridges_.bridges[b]];
      unchanged_[b] = value == last_[b] ? unchanged_[b] + 1 : 0;
      last_[b] = value;
      if (unchanged_[b] >= most_unchanged) dead_until_ = first + f + 1;
      kept_[at][b + 1] = static_cast<float>(value) * 0x1p-31f;
    }
    again = again && kept_[at] == before;
    next_ = next_ + 1 == n ? 0 : next_ + 1;
  }
  filled_ = std::min(n, filled_ + count);
  end_ = first + count;
  repeated_ = again ? repeated_ + count : 0;
  if (repeated_ >= most_unchanged) dead_until_ = end_;
}

FingerSample BridgeWindow::sample() const noexcept {
  const int n = window_frames_;
  FingerSample result;
  result.frame = end_ - n / 2;
  result.fault = Fault::force;
  if (filled_ < n || dead_until_ > end_ - n) return result;
  std::array<float, 4> re{}, im{};
  const auto add = [&](std::size_t ring, std::size_t tap) {
    for (std::size_t c = 0; c < 4; ++c) {
      re[c] += kept_[ring][c] * cosine_[tap];
      im[c] -= kept_[ring][c] * sine_[tap];
    }
  };
  const auto oldest = static_cast<std::size_t>(next_), count = static_cast<std::size_t>(n);
  for (std::size_t i = 0; i < count - oldest; ++i) add(oldest + i, i);
  for (std::size_t i = count - oldest; i < count; ++i) add(i + oldest - count, i);
  std::array<std::complex<double>, 4> z;
  for (std::size_t c = 0; c < 4; ++c) z[c] = {static_cast<double>(re[c]), static_cast<double>(im[c])};
  const double amplitude = std::abs(z[0]);
  if (!(std::abs(amplitude - bridges_.reference_amplitude) <=
        reference_tolerance * bridges_.reference_amplitude)) {
    result.fault = Fault::reference;
    return result;
  }
  std::array<double, 3> force{};
  for (std::size_t b = 0; b < 3; ++b) {
    const auto ratio = z[b + 1] / z[0] * std::polar(1.0, -bridges_.rotation_rad[b]);
    if (!(std::abs(ratio) <= overload_share * bridges_.full_scale[b]) ||
        std::abs(ratio.imag()) > quadrature_share * bridges_.full_scale[b])
      return result;
    for (std::size_t k = 0; k < 3; ++k) force[k] += (ratio.real() - bridges_.tare[b]) * bridges_.matrix[b][k];
  }
  result.normal_N = force[0], result.lateral_N = force[1], result.moment_Nm = force[2];
  result.fault = Fault::none;
  return result;
}

void FingerEstimator::start(double place_m, double variance) noexcept {
  finger_.place_m = place_m;
  finger_.speed_m_s = finger_.travelled_m = 0;
  pp_ = variance, pv_ = 0, vv_ = start_speed_m_s * start_speed_m_s;
  knows_place_ = true;
  jumps_ = 0;
}

void FingerEstimator::follow(double measured_m, double variance, double step_s) noexcept {
  const double q = settings_.acceleration_density;
  const double predicted = finger_.place_m + step_s * finger_.speed_m_s;
  pp_ += step_s * (2 * pv_ + step_s * vv_) + q * step_s * step_s * step_s / 3;
  pv_ += step_s * vv_ + q * step_s * step_s / 2;
  vv_ += q * step_s;
  const double miss = measured_m - predicted;
  if (std::abs(miss) > jump_m) {
    finger_.place_m = predicted;
    ++jumps_;
    return;
  }
  jumps_ = 0;
  const double kp = pp_ / (pp_ + variance), kv = pv_ / (pp_ + variance);
  const double before_m_s = finger_.speed_m_s;
  finger_.place_m = predicted + kp * miss;
  finger_.speed_m_s += kv * miss;
  vv_ -= kv * pv_, pv_ -= kp * pv_, pp_ -= kp * pp_;
  finger_.travelled_m = (before_m_s > 0) == (finger_.speed_m_s > 0)
                            ? finger_.travelled_m + std::abs(finger_.speed_m_s) * step_s
                            : 0;
}

FingerEstimator::FingerEstimator(const EstimatorSettings& settings) : settings_(settings) {
  const auto& s = settings;
  need(s.rate_Hz > 0 && std::isfinite(s.first_m) && std::isfinite(s.last_m) && s.first_m < s.last_m,
       "estimator: the rate is not above 0, or the strip has no length");
  for (const double value : {s.moment_noise_Nm, s.acceleration_density, s.release_N})
    need(std::isfinite(value) && value > 0, "estimator: noise, density or force is not above 0");
  need(std::isfinite(s.skin_m_per_N) && s.skin_m_per_N >= 0, "estimator: the skin is below 0 or not known");
  need(s.release_N <= s.contact_N && s.contact_N <= s.least_normal_N && std::isfinite(s.least_normal_N),
       "estimator: release, contact and least normal force do not ascend");
}

const Finger& FingerEstimator::push(const FingerSample& sample) noexcept {
  const double step_s =
      (static_cast<double>(sample.frame) - static_cast<double>(finger_.frame)) / settings_.rate_Hz;
  finger_.frame = sample.frame;
  if (sample.fault != Fault::none || !std::isfinite(sample.normal_N + sample.lateral_N + sample.moment_Nm)) {
    finger_.fault = sample.fault != Fault::none ? sample.fault : Fault::force;
    knows_place_ = false;
    return finger_;
  }
  finger_.normal_N = sample.normal_N, finger_.lateral_N = sample.lateral_N;
  finger_.contact = sample.normal_N >= (finger_.contact ? settings_.release_N : settings_.contact_N);
  if (!finger_.contact || sample.normal_N < settings_.least_normal_N) {
    finger_.fault = finger_.contact ? Fault::position : Fault::lifted;
    knows_place_ = false;
    return finger_;
  }
  const double measured_m = sample.moment_Nm / sample.normal_N + settings_.skin_m_per_N * sample.lateral_N;
  const double sd_m = settings_.moment_noise_Nm / sample.normal_N;
  if (!std::isfinite(measured_m)) {
    finger_.fault = Fault::force;
    knows_place_ = false;
    return finger_;
  }
  if (!knows_place_ || jumps_ > most_jumps)
    start(measured_m, sd_m * sd_m);
  else
    follow(measured_m, sd_m * sd_m, step_s);
  const bool beyond =
      !(finger_.place_m >= settings_.first_m - beyond_m && finger_.place_m <= settings_.last_m + beyond_m);
  finger_.fault = beyond || jumps_ > 0 ? Fault::position : Fault::none;
  return finger_;
}

}  // namespace turnpoint::follow
