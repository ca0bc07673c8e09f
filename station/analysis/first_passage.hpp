#pragma once
#include <array>

namespace turnpoint::analysis {

/// A diffusion between two boundaries, in the scaling s = 1: noise with a standard deviation of 1 after 1 s.
/// It starts at `start` x `boundary` above the lower boundary (0), drifts towards the upper one (`boundary`)
/// at `drift` per s, and is absorbed at the boundary that it meets first. Between trials, the drift may vary
/// (normal distribution), and before the process starts a further time may pass (uniform distribution).
struct Diffusion {
  double drift = 0;          ///< per s, any finite number
  double boundary = 1;       ///< separation of the boundaries, above 0
  double start = 0.5;        ///< relative start point, above 0 and below 1
  double drift_sd = 0;       ///< standard deviation of the drift between trials, 0 or more
  double delay_range_s = 0;  ///< the start is delayed by a time between 0 and this, 0 or more
};

/// The density of being absorbed at the upper or lower boundary, for many times: what does not depend on the
/// time is computed once. Uses the series for short or for long times, whichever needs fewer terms (Navarro &
/// Fuss 2009). The drift's variability is in closed form (Tuerlinckx 2004, Behav. Res. Methods 36:702-716).
/// The mean over the delays is the probability of arriving between two times, divided by their distance: for
/// a fixed drift, the difference of two sums of sines, term by term; otherwise by Gauss-Legendre quadrature.
/// The relative error of the density is below 1e-8 where it exceeds 1e-30, that of its logarithm below 1e-6
/// elsewhere.
class FirstPassageDensity {
 public:
  FirstPassageDensity(const Diffusion& diffusion, bool upper);
  /// Logarithm of the density (1/s) at `time_s`; -infinity for times of 0 or less.
  double log_at(double time_s) const;
  /// The density itself, which takes less time; below 1e-300 it may be 0.
  double at(double time_s) const;

 private:
  static constexpr int kSines = 14;
  /// factor exp(exponent)
  struct Scaled {
    double factor, exponent;
  };
  Scaled driftless(double u) const;
  Scaled without_delay(double time_s) const;
  double log_without_delay(double time_s) const;
  double log_between(double from_s, double to_s) const;
  template <class Weight>
  double log_arrivals(double from_s, double to_s, const Weight& weight) const;
  friend double log_distribution(const Diffusion& diffusion, bool upper, double time_s);
  friend double log_tail(const Diffusion& diffusion, bool upper, double time_s);

  Diffusion diffusion_;
  double relative_, opposite_, distance_, drift_away_;  // seen from the boundary
  double variance_, per_boundary2_;
  std::array<double, kSines> sines_{};  // k sin(k pi relative), k = 1, 2, ...
  std::array<double, kSines> rates_{};  // at which the terms of the sum of sines fall, per s
};

/// Logarithm of the probability of having been absorbed at this boundary by `time_s` (Blurton, Kesselmeier &
/// Gondan 2012 for short times, the series of sines for long ones; with variability the integral of the
/// density). The same accuracy, for any variability.
double log_distribution(const Diffusion& diffusion, bool upper, double time_s);

/// Logarithm of the probability of being absorbed at this boundary after `time_s`. The same accuracy.
double log_tail(const Diffusion& diffusion, bool upper, double time_s);

/// Logarithm of the probability of not having been absorbed by `time_s`: what an answer that came too late
/// tells.
double log_survival(const Diffusion& diffusion, double time_s);

/// Probability of being absorbed at the upper boundary at any time.
double upper_probability(const Diffusion& diffusion);

}  // namespace turnpoint::analysis
