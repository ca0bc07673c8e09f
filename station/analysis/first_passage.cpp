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

/// k sin(k pi w), from the nearer boundary, so that it is exact beside both.
double weighted_sine(int k, double relative, double opposite) {
  return k * (relative <= 0.5 ? std::sin(k * kPi * relative)
                              : (k % 2 == 0 ? -1 : 1) * std::sin(k * kPi * opposite));
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
    sum += weighted_sine(k, d.relative, d.opposite) / rate * std::exp(-fall);
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
double log_distribution_of(const Seen& d, double t) {
  const double factor = -d.drift_away * d.distance;
  if (t < kShortDistribution * d.separation * d.separation) return factor + log_short_distribution(d, t);
  return factor + log_difference(log_ever(d), log_long_tail(d, t));
}

double log_tail_of(const Seen& d, double t) {
  return -d.drift_away * d.distance + (t > 0 ? log_tail_without_factor(d, t) : log_ever(d));
}

/// Half of the places and weights of Gauss-Legendre's rules with 6 and with 12 nodes.
constexpr double kFewNodes[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
constexpr double kFewWeights[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
constexpr double kNodes[] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                             0.7699026741943047, 0.9041172563704749, 0.9815606342467192};
constexpr double kWeights[] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                               0.1600783285433462, 0.1069393259953184, 0.0471753363865118};

/// Adds the logarithm of the integral of exp(g) from `from` to `to` to `total`, by Gauss-Legendre's rule.
template <class G>
double with_panel(double total, double from, double to, bool flat, const G& g) {
  const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
  const auto* nodes = flat ? kFewNodes : kNodes;
  const auto* weights = flat ? kFewWeights : kWeights;
  const int pairs = flat ? 3 : 6;
  double values[12], top = kNever;
  for (int i = 0; i < pairs; ++i) {
    values[2 * i] = g(middle + half * nodes[i]);
    values[2 * i + 1] = g(middle - half * nodes[i]);
    top = std::max({top, values[2 * i], values[2 * i + 1]});
  }
  if (top == kNever) return total;
  double sum = 0;
  for (int i = 0; i < 2 * pairs; ++i) sum += weights[i / 2] * std::exp(values[i] - top);
  return log_sum(total, top + std::log(half * sum));
}

}  // namespace

FirstPassageDensity::FirstPassageDensity(const Diffusion& diffusion, bool upper) : diffusion_(diffusion) {
  const auto seen = seen_from(diffusion, upper);
  relative_ = seen.relative, opposite_ = seen.opposite, distance_ = seen.distance;
  drift_away_ = seen.drift_away;
  variance_ = diffusion.drift_sd * diffusion.drift_sd;
  per_boundary2_ = 1 / (seen.separation * seen.separation);
  // The density itself has terms up to k = 5; only a delay needs all of them, and their rates.
  const int terms = diffusion.delay_range_s > 0 ? kSines : 5;
  for (int k = 1; k <= terms; ++k) {
    const auto i = static_cast<std::size_t>(k - 1);
    sines_[i] = diffusion.start == 0.5 ? k * std::array{0, 1, 0, -1}[static_cast<std::size_t>(k % 4)]
                                       : weighted_sine(k, relative_, opposite_);
    rates_[i] = 0.5 * (drift_away_ * drift_away_ + kPi * kPi * k * k * per_boundary2_);
  }
}

/// The density of the passage through 0 of a driftless diffusion between 0 and 1, at the time u. The terms
/// are powers of two exponentials.
FirstPassageDensity::Scaled FirstPassageDensity::driftless(double u) const {
  if (!(u > 1e-290)) return {0, 0};
  const double w = relative_;
  if (u >= kShortDensity) {
    const double q = std::exp(-kPi * kPi / 2 * u), q3 = q * q * q, q8 = q3 * q3 * q * q,
                 q15 = q8 * q3 * q3 * q;
    const double sum =
        sines_[0] + q3 * sines_[1] + q8 * sines_[2] + q15 * sines_[3] + q8 * q8 * q8 * sines_[4];
    return {std::max(0.0, kPi * sum), -kPi * kPi / 2 * u};
  }
  // (w + 2k) exp(-((w + 2k)^2 - w^2) / 2u), in pairs of k and -k, so that a start close to the other boundary
  // loses no digits
  double sum = w;
  if (w > 0.5 && opposite_ < 1e-3) {
    // w (k = 0) and the term -(w - 2) of k = -1 almost cancel; write both around 1
    const double e = opposite_;
    sum = (1 - e) * -std::expm1(-2 * e / u) - 2 * e * std::exp(-2 * e / u);
    for (int k = 1; k < 40; ++k) {
      const double base = 2 * k + 1, near = base - e;
      const double decay = std::exp(-(near * near - (1 - e) * (1 - e)) / (2 * u));
      sum += decay * (near * -std::expm1(-2 * base * e / u) - 2 * e * std::exp(-2 * base * e / u));
      if ((near * near - 1) / (2 * u) > kNegligible + 10) break;
    }
  } else if (const double fall = 2 * (1 - w) / u; fall < kNegligible) {
    const double down = std::exp(-fall), up = std::exp(-2 * (1 + w) / u), both = down * up;
    const double both3 = both * both * both;
    sum += (2 + w) * up - (2 - w) * down + both * ((4 + w) * up * up - (4 - w) * down * down) +
           both3 * ((6 + w) * up * up * up - (6 - w) * down * down * down);
  }
  if (!(sum > 0)) return {0, 0};
  if (u < 1e-60) return {sum / std::sqrt(2 * kPi), -w * w / (2 * u) - 1.5 * std::log(u)};
  return {sum / (std::sqrt(2 * kPi * u) * u), -w * w / (2 * u)};
}

FirstPassageDensity::Scaled FirstPassageDensity::without_delay(double t) const {
  const double v = drift_away_, z = distance_;
  auto density = driftless(t * per_boundary2_);
  density.factor *= per_boundary2_;
  if (variance_ == 0) {
    density.exponent += -v * z - 0.5 * v * v * t;
  } else {
    const double spread = 1 + variance_ * t;
    density.factor /= std::sqrt(spread);
    density.exponent += (variance_ * z * z - 2 * v * z - v * v * t) / (2 * spread);
  }
  return density;
}

double FirstPassageDensity::log_without_delay(double t) const {
  const auto density = without_delay(t);
  return density.factor > 0 ? std::log(density.factor) + density.exponent : kNever;
}

double FirstPassageDensity::at(double time_s) const {
  if (diffusion_.delay_range_s > 0) return std::exp(log_at(time_s));
  if (!(time_s > 0)) return 0;
  const auto density = without_delay(time_s);
  return density.factor * std::exp(density.exponent);
}

/// Logarithm of the probability of arriving between two times, from the sum of sines; for a fixed drift, and
/// for times whose sum has no more than kSines terms.
double FirstPassageDensity::log_between(double from_s, double to_s) const {
  const double length_s = to_s - from_s, unit = 0.5 * kPi * kPi * per_boundary2_;
  const double y = std::exp(-unit * from_s), z = std::exp(-unit * length_s);
  // exp(-(k^2 - 1) unit from) and exp(-rate length) of term k, by their ratios to the term before
  double left = 1, left_ratio = y * y * y;
  double gone = std::exp(-rates_[0] * length_s), gone_ratio = z * z * z;
  double sum = sines_[0] / rates_[0] * -std::expm1(-rates_[0] * length_s);
  for (std::size_t k = 1; k < sines_.size(); ++k) {
    left *= left_ratio, left_ratio *= y * y;
    gone *= gone_ratio, gone_ratio *= z * z;
    if (left < 1e-19) break;
    sum += sines_[k] / rates_[k] * left * (1 - gone);
  }
  if (!(sum > 0)) return kNever;
  return std::log(kPi * per_boundary2_ * sum) - rates_[0] * from_s - drift_away_ * distance_;
}

double FirstPassageDensity::log_at(double time_s) const {
  if (!(time_s > 0)) return kNever;
  const double range_s = diffusion_.delay_range_s;
  if (range_s == 0) return log_without_delay(time_s);
  constexpr double kLongBetween = 0.06, kShortestRange = 1e-6;
  const double from_s = time_s - range_s;
  if (variance_ == 0 && range_s * rates_[0] > kShortestRange && from_s * per_boundary2_ > kLongBetween)
    return log_between(from_s, time_s) - std::log(range_s);
  if (variance_ == 0) {  // the difference of two distributions, where little of it cancels
    const Seen seen{drift_away_, diffusion_.boundary, distance_, relative_, opposite_};
    const double by_now = log_distribution_of(seen, time_s);
    const double before = from_s > 0 ? log_distribution_of(seen, from_s) : kNever;
    if (before < by_now - 0.1) return log_difference(by_now, before) - std::log(range_s);
  }
  return log_arrivals(std::max(from_s, 0.0), time_s, [](double) { return 1.0; }) - std::log(range_s);
}

/// Logarithm of the integral of weight(t) times the density without delay, from one time to another, which
/// may be infinite. All that is summed is positive, so nothing cancels. Panels go from `to_s` (or from where
/// the density is large) to shorter times, and then to longer ones. In a panel the density changes by a
/// factor of about e^5 at most for each of the three reasons that it has: the way to the boundary (z^2 / 2t),
/// the way between the boundaries (pi^2 t / 2 a^2), and the drift's exponent, whose slope is -d^2 / 2 (1 +
/// sd^2 t)^2.
template <class Weight>
double FirstPassageDensity::log_arrivals(double from_s, double to_s, const Weight& weight) const {
  const double z2 = distance_ * distance_, fall = 0.5 * kPi * kPi * per_boundary2_;
  const double d = drift_away_ - variance_ * distance_;
  const auto slope = [&](double t) {  // the largest from there on
    const double spread = 1 + variance_ * t;
    return 0.5 * d * d / (spread * spread);
  };
  const auto g = [&](double t) {
    const double w = weight(t);
    return w > 0 ? log_without_delay(t) + std::log(w) : kNever;
  };
  const auto flat = [&](double low, double high) {
    return high < 1.5 * low && z2 / 2 * (1 / low - 1 / high) + (fall + slope(low)) * (high - low) < 1.5;
  };
  constexpr double kChange = 5;
  double total = kNever;
  const double middle = std::isinf(to_s) ? std::max(from_s, z2) : to_s;
  // the density is at most that of a passage through one boundary, and the drift's exponent that at time 0
  const double highest = 0.5 * variance_ * z2 - drift_away_ * distance_ + std::log(distance_);
  for (double high = middle; high > from_s;) {
    if (3 * high < z2 && highest - z2 / (2 * high) - 0.5 * std::log(high) < total - kNegligible) break;
    double low = std::max({from_s, high / 2, 1 / (1 / high + 2 * kChange / z2)});
    low = std::max(low, high - kChange / (fall + slope(low)));
    if (!(low < high)) break;
    total = with_panel(total, low, high, flat(low, high), g);
    high = low;
  }
  for (double low = middle; low < to_s;) {
    const double rise = 1 / low - 2 * kChange / z2;
    double high = std::min({to_s, 2 * low, low + kChange / (fall + slope(low))});
    if (rise > 0) high = std::min(high, 1 / rise);
    if (!(high > low)) break;
    total = with_panel(total, low, high, flat(low, high), g);
    low = high;
    if (low > z2 && g(low) + std::log(10 / fall) < std::max(total, -1e9) - kNegligible) break;
  }
  return total;
}

double log_distribution(const Diffusion& diffusion, bool upper, double time_s) {
  if (!(time_s > 0)) return kNever;
  const double range_s = diffusion.delay_range_s;
  if (diffusion.drift_sd == 0 && range_s == 0)
    return log_distribution_of(seen_from(diffusion, upper), time_s);
  const FirstPassageDensity density(diffusion, upper);
  const double from_s = std::max(time_s - range_s, 0.0);
  const double whole = density.log_arrivals(0, from_s, [](double) { return 1.0; });
  if (range_s == 0) return whole;
  return log_sum(whole,
                 density.log_arrivals(from_s, time_s, [&](double t) { return (time_s - t) / range_s; }));
}

double log_tail(const Diffusion& diffusion, bool upper, double time_s) {
  const double range_s = diffusion.delay_range_s;
  if (diffusion.drift_sd == 0 && range_s == 0) return log_tail_of(seen_from(diffusion, upper), time_s);
  const FirstPassageDensity density(diffusion, upper);
  const auto above = [&](double from_s) {
    return density.log_arrivals(std::max(from_s, 0.0), std::numeric_limits<double>::infinity(),
                                [](double) { return 1.0; });
  };
  if (range_s == 0 || time_s <= 0) return above(time_s);
  const auto late = [&](double t) { return (t - time_s + range_s) / range_s; };
  return log_sum(above(time_s), density.log_arrivals(std::max(time_s - range_s, 0.0), time_s, late));
}

double log_survival(const Diffusion& diffusion, double time_s) {
  if (!(time_s > 0)) return 0;
  const double sum = log_sum(log_tail(diffusion, true, time_s), log_tail(diffusion, false, time_s));
  return std::min(sum, 0.0);
}

double upper_probability(const Diffusion& diffusion) {
  const auto seen = seen_from(diffusion, true);
  if (diffusion.drift_sd > 0) return std::exp(std::min(0.0, log_tail(diffusion, true, 0)));
  const double v = std::fabs(seen.drift_away);
  if (v * seen.separation < 1e-8) return std::exp(-seen.drift_away * seen.distance + log_ever(seen));
  return std::exp(-(seen.drift_away + v) * seen.distance) *
         std::expm1(-2 * v * seen.separation * seen.opposite) / std::expm1(-2 * v * seen.separation);
}

}  // namespace turnpoint::analysis
