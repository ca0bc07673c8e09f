#pragma once
// A plant for the tests of station/follow. It shares no code with the room that is tested: the strip's field
// is a closed formula, the plate's envelope and the air film are first-order lags, friction is a closed
// formula of the amplitude, the skin is a spring that sticks and slips, and the force cells are resonators
// with noise.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace plant {

inline constexpr double kRate_Hz = 192000;
inline constexpr int kPeriod = 96, kSteps = 8;
inline constexpr double kStep_s = kPeriod / kRate_Hz / kSteps;

/// Uniform numbers and a bell-shaped sum of them.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 0x1234567) {
    for (int i = 0; i < 8; ++i) next();
  }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double bell() { return (uniform() + uniform() + uniform() + uniform() - 2) * 1.7320508; }

 private:
  std::uint64_t next() {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return state_;
  }
  std::uint64_t state_;
};

struct Setup {
  // the strip: displacement at gain 1
  double length_m = 0.2, boundary_m = 0.17, displacement_um = 2.5;
  // the finger's friction: floor + (1 - floor) / (1 + (amplitude / half)^power), times `friction` at rest
  double friction = 1.0, floor = 0.1, half_um = 1.0, power = 2.0;
  double fingertip_m = 0.008;
  double quality = 60, resonance_Hz = 30000, film_s = 0.5e-3;
  double skin_N_per_m = 1000, static_excess = 0;
  double drift_per_s = 0;                     // of the logarithm of friction
  std::function<double(double)> disturbance;  // of the logarithm of friction, over time
  double roughness = 0;                       // rms of noise of friction, up to 400 Hz
  // force cells a and b at x = 0 and x = span, and their electronics
  double span_m = 0.3, cells_Hz = 400, damping = 0.15, noise_N = 0.4e-3;
  double added_delay_s = 0;  // of the readings; nobody knows of it
  std::uint64_t seed = 1;
  // what the hand does, over time
  std::function<double(double)> hand_m = [](double) { return 0.05; };
  std::function<double(double)> press_N = [](double) { return 0.5; };
};

inline double field_um(const Setup& s, double x_m) {
  const double x = std::clamp(x_m, 0.0, s.length_m);
  if (x < s.boundary_m) return s.displacement_um * (0.7 + 0.3 * x / s.boundary_m);
  return s.displacement_um * std::exp(-(x - s.boundary_m) / 0.004);
}
inline double relative_friction(const Setup& s, double amplitude_um) {
  return s.floor + (1 - s.floor) / (1 + std::pow(amplitude_um / s.half_um, s.power));
}

/// What one reading of the cells gives, half a window after the fact.
struct Reading {
  double normal_N = 0, lateral_N = 0, moment_Nm = 0;
};

class Plant {
 public:
  explicit Plant(Setup setup) : s_(std::move(setup)), dice_(s_.seed) {
    tau_s_ = s_.quality / (3.14159265358979 * s_.resonance_Hz);
    hand_m_ = s_.hand_m(0);
    double sum = 0;
    for (int i = 0; i < kWindow; ++i) {
      const double w = std::sin(3.14159265358979 * (i + 0.5) / kWindow);
      weight_[static_cast<std::size_t>(i)] = w * w * w * w;
      sum += w * w * w * w;
    }
    double square = 0;
    for (double& w : weight_) w /= sum, square += w * w;
    noise_ = s_.noise_N / std::sqrt(square);
    late_ = static_cast<std::size_t>(std::lround(s_.added_delay_s / kStep_s));
    ring_.assign(late_ + kWindow, {});
  }

  /// One eighth of a period: the gain goes in a straight line to `gain`.
  void step(double gain) {
    // the trapezoidal rule for tau a' = g - a
    const double h = kStep_s / tau_s_;
    amplitude_ = (amplitude_ * (1 - h / 2) + h / 2 * (gain_ + gain)) / (1 + h / 2);
    gain_ = gain;
    time_s_ += kStep_s;
    const double hand = s_.hand_m(time_s_), moved = hand - hand_m_;
    hand_m_ = hand;
    normal_N_ = std::max(0.0, s_.press_N(time_s_));
    // the film follows the amplitude late; each part of the fingertip has its own friction
    double mean = 0;
    const double contact = hand_m_ - stretch_m_;
    for (const auto& [at, weight] : {std::pair{-0.3872983, 5.0 / 18}, {0.0, 8.0 / 18}, {0.3872983, 5.0 / 18}})
      mean += weight * relative_friction(s_, amplitude_ * field_um(s_, contact + at * s_.fingertip_m));
    film_ += (1 - std::exp(-kStep_s / s_.film_s)) * (mean - film_);
    rough_ += 0.15 * (dice_.bell() * s_.roughness / std::sqrt(0.15 / 1.85) - rough_);
    const double log_change =
        s_.drift_per_s * time_s_ + rough_ + (s_.disturbance ? s_.disturbance(time_s_) : 0.0);
    const double mu = s_.friction * film_ * std::exp(log_change);
    friction_ = mu;
    // skin: sticks up to the static limit, then slips down to the kinetic one
    const double kinetic_m = mu * normal_N_ / s_.skin_N_per_m, limit_m = kinetic_m * (1 + s_.static_excess);
    stretch_m_ += moved;
    slides_ = false;
    if (std::abs(stretch_m_) >= limit_m) {
      stretch_m_ = std::copysign(kinetic_m, stretch_m_);
      slides_ = true;
    }
    lateral_N_ = s_.skin_N_per_m * stretch_m_;
    const double x = hand_m_ - stretch_m_;
    contact_m_ = x;
    const std::array<double, 3> load{normal_N_ * (1 - x / s_.span_m), normal_N_ * x / s_.span_m, lateral_N_};
    std::array<double, 3> read{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double w = 2 * 3.14159265358979 * s_.cells_Hz, dt = kStep_s / 4;
      for (int i = 0; i < 4; ++i) {
        rate_[c] += dt * (w * w * (load[c] - moved_[c]) - 2 * s_.damping * w * rate_[c]);
        moved_[c] += dt * rate_[c];
      }
      read[c] = moved_[c] + noise_ * dice_.bell();
    }
    ring_[at_] = {read[0] + read[1], read[2], s_.span_m * read[1]};
    at_ = (at_ + 1) % ring_.size();
  }

  /// The forces half a window (0.75 ms) ago.
  Reading reading() const {
    Reading sum;
    for (std::size_t i = 0; i < kWindow; ++i) {
      const Reading& r = ring_[(at_ + i) % ring_.size()];
      sum.normal_N += weight_[i] * r.normal_N, sum.lateral_N += weight_[i] * r.lateral_N,
          sum.moment_Nm += weight_[i] * r.moment_Nm;
    }
    return sum;
  }

  /// The forces now, as the cells read them: normal, lateral, moment.
  const Reading& now() const { return ring_[(at_ + ring_.size() - 1) % ring_.size()]; }

  double time_s() const { return time_s_; }
  double gain() const { return gain_; }
  double amplitude() const { return amplitude_; }
  double place_m() const { return contact_m_; }
  double friction() const { return friction_; }  ///< the coefficient, whether or not the skin slides
  double felt() const { return std::abs(lateral_N_) / std::max(normal_N_, 1e-9); }
  double normal_N() const { return normal_N_; }
  Setup& setup() { return s_; }

 private:
  static constexpr int kWindow = 24;
  Setup s_;
  Dice dice_;
  double tau_s_, time_s_ = 0, gain_ = 0, amplitude_ = 0, hand_m_ = 0, stretch_m_ = 0, contact_m_ = 0;
  double film_ = 1, rough_ = 0, friction_ = 1, normal_N_ = 0, lateral_N_ = 0, noise_ = 0;
  bool slides_ = false;
  std::array<double, 3> moved_{}, rate_{};
  std::array<double, kWindow> weight_{};
  std::vector<Reading> ring_;
  std::size_t late_ = 0, at_ = 0;
};

}  // namespace plant
