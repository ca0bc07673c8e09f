#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "station/sensing/force_calibration.hpp"

namespace turnpoint::sensing {

/// Noise of standard deviation 1 whose power density falls as 1 / frequency between 0.25 and 250 Hz. It is a
/// sum of first-order low-pass noises, one per octave.
class PinkNoise {
 public:
  explicit PinkNoise(std::mt19937_64& random) : random_(random) {
    for (int i = 0; i < octaves; ++i) {
      keep_[i] = std::exp(-2 * 3.14159265 * 0.25 * std::pow(2.0, i) / 1000);
      state_[i] = normal_(random_);
    }
  }
  double next() {
    double sum = 0;
    for (int i = 0; i < octaves; ++i) {
      state_[i] = keep_[i] * state_[i] + std::sqrt(1 - keep_[i] * keep_[i]) * normal_(random_);
      sum += state_[i];
    }
    return sum / std::sqrt(static_cast<double>(octaves));
  }

 private:
  static constexpr int octaves = 11;
  std::mt19937_64& random_;
  std::normal_distribution<double> normal_;
  double keep_[octaves]{}, state_[octaves]{};
};

/// A finger that moves to and fro over a strip on which friction has one step, and the forces that calibrated
/// cells report at 1000 points a second. Strokes have minimum jerk; the finger rests for 0.2 s between them.
struct Finger {
  double from_mm = 40, to_mm = 120, mean_speed_mm_s = 80;
  int strokes = 12;
  double normal_N = 0.5, normal_noise = 0.15, friction_noise = 0.08;
  double edge_mm = 80, width_mm = 10;
  double friction_below = 0.8, friction_above = 0.4;
  double stiffness_N_mm = 1;  ///< stiffness of the skin of the fingertip
  /// Distance that the finger has moved past the edge before it meets the change of friction.
  double lag_mm = 0;
  double cell_noise_N = 0.25e-3, span_mm = 200;

  struct Truth {
    double position_mm, speed_mm_s;  ///< position and speed of the contact
  };
  struct Recording {
    std::vector<ForcePoint> forces;
    std::vector<Truth> truth;

    /// Returns the truth averaged over 31 ms, because the noise of friction makes the contact jitter.
    Truth smooth_truth(std::size_t at) const {
      Truth mean{0, 0};
      for (std::size_t k = at - 15; k <= at + 15; ++k) {
        mean.position_mm += truth[k].position_mm / 31;
        mean.speed_mm_s += truth[k].speed_mm_s / 31;
      }
      return mean;
    }
  };

  /// Returns the friction under a finger that covers a part of both sides of the edge.
  double friction(double position_mm) const {
    const double share = std::clamp((position_mm - edge_mm) / width_mm + 0.5, 0.0, 1.0);
    return friction_below + (friction_above - friction_below) * share;
  }

  Recording record(std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    PinkNoise force_noise(random), surface_noise(random);
    Recording all;
    double pulled_mm = 0, before_mm = from_mm, contact_mm = from_mm;
    const double duration_s = std::abs(to_mm - from_mm) / mean_speed_mm_s, period_s = duration_s + 0.2;
    const int points = static_cast<int>(1000 * (strokes * period_s + 0.6));
    for (int i = 0; i < points; ++i) {
      const double t = i / 1000.0 - 0.3;
      const int stroke = std::clamp(static_cast<int>(std::floor(t / period_s)), 0, strokes - 1);
      const double s = std::clamp((t - stroke * period_s) / duration_s, 0.0, 1.0);
      const double way = s * s * s * (10 - 15 * s + 6 * s * s);
      const bool back = stroke % 2 == 1;
      const double finger_mm = from_mm + (to_mm - from_mm) * (back ? 1 - way : way);
      const double force_N = normal_N * std::max(0.05, 1 + normal_noise * force_noise.next());
      const double direction = back ? -1 : 1;
      const double mu =
          friction(contact_mm - direction * lag_mm) * (1 + friction_noise * surface_noise.next());
      const double most_mm = std::max(0.0, mu) * force_N / stiffness_N_mm;
      pulled_mm = std::clamp(pulled_mm + finger_mm - before_mm, -most_mm, most_mm);
      before_mm = finger_mm;
      const double last_mm = contact_mm;
      contact_mm = finger_mm - pulled_mm;
      all.truth.push_back({contact_mm, 1000 * (contact_mm - last_mm)});
      const double a = force_N * (1 - contact_mm / span_mm) + cell_noise_N * normal(random);
      const double b = force_N * contact_mm / span_mm + cell_noise_N * normal(random);
      all.forces.push_back(
          {i, {a + b, stiffness_N_mm * pulled_mm + cell_noise_N * normal(random), span_mm * b}});
    }
    return all;
  }
};

}  // namespace turnpoint::sensing
