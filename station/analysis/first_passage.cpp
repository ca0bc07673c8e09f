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
      const double nearer = (down * down - w * w) / (2 * u);
      if (nearer > kNegligible) break;
      sum += up * std::exp(-(up * up - w * w) / (2 * u)) - down * std::exp(-nearer);
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

/// The same functions for one drift and no delay.
double log_density_of(const Seen& d, double drift_sd, double t) {
  const double a2 = d.separation * d.separation;
  const double v = d.drift_away, z = d.distance, variance = drift_sd * drift_sd, spread = 1 + variance * t;
  return (variance * z * z - 2 * v * z - v * v * t) / (2 * spread) - 0.5 * std::log(spread) +
         log_driftless(d.relative, d.opposite, t / a2) - std::log(a2);
}

double log_distribution_of(const Seen& d, double t) {
  const double factor = -d.drift_away * d.distance;
  if (t < kShortDistribution * d.separation * d.separation) return factor + log_short_distribution(d, t);
  return factor + log_difference(log_ever(d), log_long_tail(d, t));
}

double log_tail_of(const Seen& d, double t) {
  return -d.drift_away * d.distance + (t > 0 ? log_tail_without_factor(d, t) : log_ever(d));
}

/// Logarithm of the mean of exp(g(drift)) over the drifts of a diffusion; g belongs to a probability that
/// concerns the time t. The trapezoidal rule converges exponentially: its step follows from where the
/// integrand, continued into the complex plane, grows (like that of a normal distribution with the variance 1
/// / (t + 1 / drift_sd^2)) or has its poles (at i pi / boundary).
template <class G>
double over_drifts(const Diffusion& d, double t, const G& g) {
  if (d.drift_sd == 0) return g(d.drift);
  const double precision = 1 / (d.drift_sd * d.drift_sd), root = std::sqrt(std::max(t, 0.0) + precision);
  const double scaled = root / d.boundary;
  double step = 0.7 / root;
  if (scaled < 2.9)
    step = std::min(step, 2 * kPi * kPi / (d.boundary * (36 + kPi * kPi / 2 * scaled * scaled)));
  const auto term = [&](double i) {
    const double v = d.drift + i * step;
    return g(v) - 0.5 * (i * step) * (i * step) * precision;
  };
  // the integrand has one peak; climb to it with steps that double, then halve
  double peak = 0, top = term(0);
  for (double stride = 1; stride >= 1;) {
    const double up = term(peak + stride), down = term(peak - stride);
    if (up > top)
      peak += stride, top = up, stride *= 2;
    else if (down > top)
      peak -= stride, top = down, stride *= 2;
    else
      stride = stride > 1 ? std::floor(stride / 2) : 0;
  }
  if (top == kNever) return kNever;
  double sum = 1;
  for (const double direction : {1.0, -1.0})
    for (int i = 1; i < 100000; ++i) {
      const double below = term(peak + direction * i) - top;
      sum += std::exp(below);
      if (below < -kNegligible) break;
    }
  return top + std::log(sum * step / (d.drift_sd * std::sqrt(2 * kPi)));
}

/// Half of the places and weights of Gauss-Legendre's rules with 6 and with 12 nodes.
constexpr double kFewNodes[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
constexpr double kFewWeights[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
constexpr double kNodes[] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                             0.7699026741943047, 0.9041172563704749, 0.9815606342467192};
constexpr double kWeights[] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                               0.1600783285433462, 0.1069393259953184, 0.0471753363865118};

/// Logarithm of the mean of exp(g(s)) over the start's delays, for the time t: s runs from t - delay_range_s to
/// t. Before the process starts, g is `before`. Gauss-Legendre in panels in which the integrand changes by a
/// factor of about e^5 at most, with fewer nodes where it changes little; `distance` is that from the start to
/// the boundary.
template <class G>
double over_delays(const Diffusion& d, double t, double distance, double before, const G& g) {
  if (d.delay_range_s == 0) return t > 0 ? g(t) : before;
  const double low = t - d.delay_range_s, end = std::max(low, 0.0), z2 = distance * distance;
  double total = low < 0 ? before + std::log(std::min(-low, d.delay_range_s)) : kNever;
  const double v = std::fabs(d.drift), variance = d.drift_sd * d.drift_sd;
  // the fastest fall of the integrand at long times, and when nothing can have arrived
  const double fall = 0.5 * (v * v + kPi * kPi / (d.boundary * d.boundary) +
                             variance * (1 + variance * z2 + 2 * v * distance));
  const double nothing = kNegligible + 10 + v * distance + variance * z2 / 2;
  for (double high = t; high > end;) {
    if (z2 / (2 * high) > nothing) {
      if (before > kNever)
        return log_sum(total, before + std::log(high - end)) - std::log(d.delay_range_s);
      if (z2 / (2 * high) > 700 + nothing || g(high) + std::log(high) < total - kNegligible) break;
    }
    const double from = std::max({end, high / 2, 1 / (1 / high + 10 / z2), high - 5 / fall});
    const double half = 0.5 * (high - from), middle = 0.5 * (high + from);
    const bool flat = z2 / 2 * (1 / from - 1 / high) + fall * (high - from) < 1.5 && high < 1.5 * from;
    const auto* nodes = flat ? kFewNodes : kNodes;
    const auto* weights = flat ? kFewWeights : kWeights;
    const int pairs = flat ? 3 : 6;
    double values[12], top = kNever;
    for (int i = 0; i < pairs; ++i) {
      values[2 * i] = g(middle + half * nodes[i]);
      values[2 * i + 1] = g(middle - half * nodes[i]);
      top = std::max({top, values[2 * i], values[2 * i + 1]});
    }
    if (top > kNever) {
      double sum = 0;
      for (int i = 0; i < 2 * pairs; ++i) sum += weights[i / 2] * std::exp(values[i] - top);
      total = log_sum(total, top + std::log(half * sum));
    }
    if (!(from < high)) break;
    high = from;
  }
  return total - std::log(d.delay_range_s);
}

}  // namespace

double log_density(const Diffusion& diffusion, bool upper, double time_s) {
  if (!(time_s > 0)) return kNever;
  const auto d = seen_from(diffusion, upper);
  return over_delays(diffusion, time_s, d.distance, kNever,
                     [&](double t) { return log_density_of(d, diffusion.drift_sd, t); });
}

double log_distribution(const Diffusion& diffusion, bool upper, double time_s) {
  if (!(time_s > 0)) return kNever;
  auto d = seen_from(diffusion, upper);
  return over_delays(diffusion, time_s, d.distance, kNever, [&](double t) {
    return over_drifts(diffusion, t, [&](double drift) {
      d.drift_away = upper ? -drift : drift;
      return log_distribution_of(d, t);
    });
  });
}

double log_tail(const Diffusion& diffusion, bool upper, double time_s) {
  auto d = seen_from(diffusion, upper);
  const auto of = [&](double t) {
    return over_drifts(diffusion, t, [&](double drift) {
      d.drift_away = upper ? -drift : drift;
      return log_tail_of(d, t);
    });
  };
  return over_delays(diffusion, time_s, d.distance, time_s <= 0 || time_s < diffusion.delay_range_s ? of(0) : kNever, of);
}

double log_survival(const Diffusion& diffusion, double time_s) {
  if (!(time_s > 0)) return 0;
  const double sum = log_sum(log_tail(diffusion, true, time_s), log_tail(diffusion, false, time_s));
  return std::min(sum, 0.0);
}

double upper_probability(const Diffusion& diffusion) {
  auto d = seen_from(diffusion, true);
  return std::exp(over_drifts(diffusion, 0, [&](double drift) {
    d.drift_away = -drift;
    return -d.drift_away * d.distance + log_ever(d);
  }));
}

}  // namespace turnpoint::analysis
