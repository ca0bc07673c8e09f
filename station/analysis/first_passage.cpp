#include "station/analysis/first_passage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace turnpoint::analysis {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNever = -std::numeric_limits<double>::infinity();
/// Times in units of boundary^2 (s = 1) below which the series for short times is used.
constexpr double kShortDensity = 0.35, kShortDistribution = 1.5;
/// A term is negligible if its logarithm is this far below that of the sum.
constexpr double kNegligible = 42;

/// A diffusion seen from one boundary: its drift away from this boundary, the boundaries' separation, and the
/// distance and relative distance between start and boundary.
struct Seen {
  double drift_away, separation, distance, relative, opposite;
};
Seen seen_from(const Diffusion& d, bool upper) {
  const double w = upper ? 1 - d.start : d.start;
  return {upper ? -d.drift : d.drift, d.boundary, d.boundary * w, w, upper ? d.start : 1 - d.start};
}

double log_sum(double a, double b) {
  if (a < b) std::swap(a, b);
  return b == kNever ? a : a + std::log1p(std::exp(b - a));
}
/// log(exp(a) - exp(b)) for a >= b.
double log_difference(double a, double b) {
  if (b == kNever) return a;
  const double gap = b - a;
  if (!(gap < 0)) return kNever;
  return a + (gap > -0.6931 ? std::log(-std::expm1(gap)) : std::log1p(-std::exp(gap)));
}

/// Logarithm of the upper tail of the standard normal distribution.
double log_normal_tail(double x) {
  if (x < 12) return std::log(0.5 * std::erfc(x / std::numbers::sqrt2));
  // the continued fraction of Mills' ratio, from its tail
  double fraction = x;
  for (int k = 60; k > 0; --k) fraction = x + k / fraction;
  return -0.5 * x * x - 0.5 * std::log(2 * kPi) - std::log(fraction);
}

/// A sum of positive and of negative terms, kept by their logarithms.
struct SignedSum {
  double positive = kNever, negative = kNever;
  void add(bool plus, double log_term) {
    (plus ? positive : negative) = log_sum(plus ? positive : negative, log_term);
  }
  double log_value() const { return log_difference(positive, negative); }
};

/// Logarithm of the density of the first passage through 0 of a driftless diffusion from `relative` between 0
/// and 1, at the time u; of the two series the one that needs fewer terms.
double log_driftless(double relative, double opposite, double u) {
  if (u < kShortDensity) {
    // sum of (w + 2k) exp(-(w + 2k)^2 / 2u), relative to the term with k = 0; the terms of k and -k are
    // paired, so that a start close to the other boundary (w near 1) loses no digits: w - 2 = -(w + 2
    // opposite) etc.
    const double w = relative;
    double sum = w;
    for (int k = 1; k < 40; ++k) {
      const double up = w + 2 * k, down = 2 * k - w;  // |w - 2k|
      sum += up * std::exp(-(up * up - w * w) / (2 * u)) - down * std::exp(-(down * down - w * w) / (2 * u));
      if ((down * down - w * w) / (2 * u) > kNegligible + 10) break;
    }
    if (w > 0.5 && opposite < 1e-3) {
      // w (k = 0) and the term -(w - 2) of k = -1 almost cancel; write both around 1
      const double e = opposite, q = std::exp(-2 * e / u);  // exp(-((1+e)^2 - (1-e)^2)/2u)
      sum = (1 - e) * -std::expm1(-2 * e / u) - 2 * e * q;
      for (int k = 1; k < 40; ++k) {
        const double base = 2 * k + 1;
        const double near = base - e;
        const double decay = std::exp(-(near * near - (1 - e) * (1 - e)) / (2 * u));
        sum += decay * (near * -std::expm1(-2 * base * e / u) - 2 * e * std::exp(-2 * base * e / u));
        if ((near * near - 1) / (2 * u) > kNegligible + 10) break;
      }
    }
    if (!(sum > 0)) return kNever;
    return std::log(sum) - w * w / (2 * u) - 0.5 * std::log(2 * kPi * u * u * u);
  }
  double sum = 0;
  const double step = kPi * kPi * u / 2;
  for (int k = 1; k < 40; ++k) {
    const double fall = step * (k * k - 1);
    if (fall > kNegligible) break;
    // sin(k pi w) from the nearer boundary
    const double angle =
        relative <= 0.5 ? std::sin(k * kPi * relative) : (k % 2 == 0 ? -1 : 1) * std::sin(k * kPi * opposite);
    sum += k * angle * std::exp(-fall);
  }
  if (!(sum > 0)) return kNever;
  return std::log(sum) - step + std::log(kPi);
}

/// Logarithm of the probability of ever being absorbed, without the factor exp(-drift_away distance).
double log_ever(const Seen& d) {
  const double v = std::fabs(d.drift_away), rest = d.separation * d.opposite;
  if (v * d.separation <
      1e-8)  // exp(-v distance) and (1 - exp(-2 v rest)) / (1 - exp(-2 v a)), to first order
    return std::log(d.opposite) + v * (d.separation - rest) - v * d.distance;
  return -v * d.distance + std::log(-std::expm1(-2 * v * rest)) -
         std::log(-std::expm1(-2 * v * d.separation));
}

/// The distances r_k of the images of the boundary.
double image(const Seen& d, int k) {
  return k % 2 == 0 ? k * d.separation + d.distance : k * d.separation + d.separation * d.opposite;
}

/// Logarithm of the distribution without the factor exp(-drift_away distance), by the series for short times.
double log_short_distribution(const Seen& d, double t) {
  const double v = std::fabs(d.drift_away), root = std::sqrt(t);
  SignedSum sum;
  for (int k = 0; k < 200; ++k) {
    const double r = image(d, k);
    const double term =
        log_sum(-v * r + log_normal_tail((r - v * t) / root), v * r + log_normal_tail((r + v * t) / root));
    sum.add(k % 2 == 0, term);
    if (term < std::max(sum.positive, sum.negative) - kNegligible && r > v * t) break;
    if (k > 0 && term < sum.positive - kNegligible - 300) break;
  }
  return sum.log_value();
}

/// Logarithm of the tail without the same factor, by the series of sines.
double log_long_tail(const Seen& d, double t) {
  const double unit = kPi / d.separation, half_v2 = d.drift_away * d.drift_away / 2;
  const double first = half_v2 + unit * unit / 2;
  double sum = 0;
  for (int k = 1; k < 400; ++k) {
    const double rate = half_v2 + unit * unit * k * k / 2, fall = (rate - first) * t;
    if (fall > kNegligible) break;
    const double angle = d.relative <= 0.5 ? std::sin(k * kPi * d.relative)
                                           : (k % 2 == 0 ? -1 : 1) * std::sin(k * kPi * d.opposite);
    sum += k * angle / rate * std::exp(-fall);
  }
  if (!(sum > 0)) return kNever;
  return std::log(sum) - first * t + std::log(kPi) - 2 * std::log(d.separation);
}

/// Logarithm of the tail without the same factor, by images, for a drift that has carried away nearly all.
double log_short_tail(const Seen& d, double t) {
  const double v = std::fabs(d.drift_away), root = std::sqrt(t);
  SignedSum sum;
  for (int k = 0; k < 2000; ++k) {
    const double r = image(d, k);
    const double a = -v * r + log_normal_tail((v * t - r) / root),
                 b = v * r + log_normal_tail((r + v * t) / root);
    sum.add(k % 2 == 0, log_difference(a, std::min(a, b)));
    if (a < sum.positive - kNegligible && r > v * t) break;
  }
  return sum.log_value();
}

double log_tail_without_factor(const Seen& d, double t) {
  const double u = t / (d.separation * d.separation);
  if (u >= 0.06) return log_long_tail(d, t);
  if (d.drift_away * d.drift_away * t < 20) return log_difference(log_ever(d), log_short_distribution(d, t));
  return log_short_tail(d, t);
}

}  // namespace

double log_density(const Diffusion& diffusion, bool upper, double time_s) {
  if (!(time_s > 0)) return kNever;
  const auto d = seen_from(diffusion, upper);
  const double a2 = d.separation * d.separation;
  return -d.drift_away * d.distance - d.drift_away * d.drift_away * time_s / 2 +
         log_driftless(d.relative, d.opposite, time_s / a2) - std::log(a2);
}

double log_distribution(const Diffusion& diffusion, bool upper, double time_s) {
  if (!(time_s > 0)) return kNever;
  const auto d = seen_from(diffusion, upper);
  const double u = time_s / (d.separation * d.separation), factor = -d.drift_away * d.distance;
  if (u < kShortDistribution) return factor + log_short_distribution(d, time_s);
  return factor + log_difference(log_ever(d), log_long_tail(d, time_s));
}

double log_tail(const Diffusion& diffusion, bool upper, double time_s) {
  const auto d = seen_from(diffusion, upper);
  const double factor = -d.drift_away * d.distance;
  return factor + (time_s > 0 ? log_tail_without_factor(d, time_s) : log_ever(d));
}

double log_survival(const Diffusion& diffusion, double time_s) {
  if (!(time_s > 0)) return 0;
  const double sum = log_sum(log_tail(diffusion, true, time_s), log_tail(diffusion, false, time_s));
  return std::min(sum, 0.0);
}

double upper_probability(const Diffusion& diffusion) {
  const auto d = seen_from(diffusion, true);
  return std::exp(-d.drift_away * d.distance + log_ever(d));
}

}  // namespace turnpoint::analysis
