#include "physics/taylor_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/operations.hpp"

namespace turnpoint::physics {
namespace {

// The series ends where its terms are below exp(ln_truncation) times the larger of the first two.
constexpr double ln_truncation = -39.8;  // exp(-39.8) = 5e-18

// 1/((n + 1)(n + 2)), which the recurrences for the coefficients need
constexpr auto inverse_products = [] {
  std::array<double, taylor_order + 1> table{};
  for (int n = 0; n <= taylor_order; ++n) table[static_cast<std::size_t>(n)] = 1.0 / ((n + 1.0) * (n + 2.0));
  return table;
}();

// The length over which the series is accurate to rounding. It is estimated from the last three terms,
// because one or two of these may vanish by symmetry.
double exact_length(const TaylorStep& step) {
  const double size =
      std::max({std::abs(step.re[0]), std::abs(step.im[0]), std::abs(step.re[1]), std::abs(step.im[1])});
  double ln_ratio = std::numbers::ln2 * 2;  // lets a step be at most four times as long as the trial scale
  for (int n = taylor_order - 2; n <= taylor_order; ++n) {
    const double term = std::max(std::abs(step.re[n]), std::abs(step.im[n]));
    if (term > 0) ln_ratio = std::min(ln_ratio, (std::log(size / term) + ln_truncation) / n);
  }
  return step.scale * std::exp(ln_ratio);
}

}  // namespace

void TaylorState::normalise(double scale) {
  const double size = std::sqrt(std::max(std::norm(g), std::norm(dg) * scale * scale));
  const int power = std::ilogb(size);
  const double factor = std::scalbn(1.0, -power);
  g *= factor;
  dg *= factor;
  exponent += power;
}

double TaylorState::ln_scale() const { return ln_base + static_cast<double>(exponent) * std::numbers::ln2; }

SeriesMaker::SeriesMaker(const Taper& taper, const MarchEquation& equation)
    : taper_(taper), equation_(equation) {}

std::complex<double> SeriesMaker::potential(double x) const {
  const double w = taper_.half_width_m(x);
  const double slope = taper_.slope(x);
  return equation_.a - (equation_.b + equation_.c * slope * slope) / (w * w);
}

// First guess of the step's length: 3 radians or e-folds of the local solution, but at most 0.35 times the
// distance to the point where the sides would meet if they continued straight.
double SeriesMaker::trial_scale(double x) const {
  const double meet = std::abs(taper_.half_width_m(x) / taper_.slope(x));
  double scale = 0.35 * std::min(meet, 1e6 * taper_.length_m());
  const double here = std::sqrt(std::norm(potential(x)));
  const double try_in = std::max(0.0, x - std::min(scale, 3 / std::sqrt(here + 1e-300)));
  const double k = std::sqrt(std::max(here, std::sqrt(std::norm(potential(try_in)))) + 1e-300);
  return std::min({scale, 3 / k, 4 * taper_.length_m()});
}

// Taylor series of the solution on a linear taper. A five-term recurrence solves s^2 g'' + (A s^2 - mu'^2) g
// = 0 with s = s0 (1 + e tau).
template <bool lossy>
void SeriesMaker::linear(double x, TaylorStep& step) const {
  const double slope = std::get<LinearTaper>(taper_.form()).slope;
  const double s0 = taper_.half_width_m(x) / slope;
  const double e = step.scale / s0;
  const std::complex<double> a = equation_.a * (step.scale * step.scale);
  const double ar = a.real();
  [[maybe_unused]] const double ai = a.imag();
  const double strength = (equation_.b / (slope * slope) + equation_.c) * e * e;
  double* re = step.re;
  [[maybe_unused]] double* im = step.im;
  for (int n = 0; n + 2 <= taylor_order; ++n) {
    const double same = e * e * n * (n - 1.0) - strength + ar;
    const double next = 2 * e * (n + 1.0) * n;
    const double factor = -inverse_products[static_cast<std::size_t>(n)];
    // adds the term A s^2 g with s^2 = s0^2 (1 + 2 e tau + e^2 tau^2); its n-th coefficient is in `same`
    const double before_re = n >= 2 ? 2 * e * re[n - 1] + e * e * re[n - 2] : n == 1 ? 2 * e * re[0] : 0;
    double sum_re = next * re[n + 1] + same * re[n] + ar * before_re;
    if constexpr (lossy) {
      const double before_im = n >= 2 ? 2 * e * im[n - 1] + e * e * im[n - 2] : n == 1 ? 2 * e * im[0] : 0;
      sum_re -= ai * (im[n] + before_im);
      im[n + 2] = factor * (next * im[n + 1] + same * im[n] + ai * (re[n] + before_re) + ar * before_im);
    }
    re[n + 2] = factor * sum_re;
  }
}

// Computes the Taylor coefficients of p(x) - A (see taylor_march.hpp) in tau. They are real. Returns the
// number of coefficients that are not negligible.
int SeriesMaker::potential_series(double x, double knot, double scale,
                                  std::array<double, taylor_order>& q) const {
  q.fill(0);
  if (const auto* taper = std::get_if<ExponentialTaper>(&taper_.form())) {
    const double l = taper->decay_length_m;
    const double w = taper_.half_width_m(x);
    double term = -equation_.b / (w * w);
    const double size = std::abs(term);
    int count = 1;
    for (int j = 0; j < taylor_order; ++j) {
      q[static_cast<std::size_t>(j)] = term;
      if (std::abs(term) > 1e-18 * size) count = j + 1;
      term *= -2 * scale / l / (j + 1);
    }
    q[0] -= equation_.c / (l * l);
    return count;
  }
  // W(tau) is a cubic, so a recurrence gives the coefficients of 1/W^2. They are then multiplied by those of
  // the quartic B + C W'^2.
  std::array<double, 4> w{taper_.half_width_m(x), 0, 0, 0};
  if (std::holds_alternative<TabulatedTaper>(taper_.form())) {
    const Cubic& p = taper_.table().piece(0.5 * (knot + x));
    const double t = x - p.x0;
    w = {p.value(x), -scale * p.slope(x), scale * scale * (p.c2 + 3 * p.c3 * t),
         -scale * scale * scale * p.c3};
  }
  std::array<double, 5> numerator{};
  for (int i = 1; i < 4; ++i) {
    for (int j = 1; j < 4; ++j) {
      numerator[static_cast<std::size_t>(i + j - 2)] += equation_.c * i * j * w[static_cast<std::size_t>(i)] *
                                                        w[static_cast<std::size_t>(j)] / (scale * scale);
    }
  }
  numerator[0] += equation_.b;
  std::array<double, taylor_order> r{};
  r[0] = 1 / (w[0] * w[0]);
  for (std::size_t n = 1; n < r.size(); ++n) {
    double sum = 0;
    for (std::size_t k = 1; k <= std::min<std::size_t>(3, n); ++k) {
      sum += static_cast<double>(n + k) * w[k] * r[n - k];
    }
    r[n] = -sum / (static_cast<double>(n) * w[0]);
    if (std::max(std::abs(r[n]), std::abs(r[n - 1])) < 1e-22 * r[0])
      break;  // all further coefficients are negligible; short pieces of a tabulated taper need few
  }
  int count = 1;
  double size = 0;
  for (std::size_t n = 0; n < q.size(); ++n) {
    for (std::size_t k = 0; k <= std::min<std::size_t>(4, n); ++k) q[n] -= numerator[k] * r[n - k];
    size = std::max(size, std::abs(q[n]));
    if (std::abs(q[n]) > 1e-19 * size) count = static_cast<int>(n) + 1;
  }
  return count;
}

void SeriesMaker::convolved(double x, double knot, TaylorStep& step) const {
  std::array<double, taylor_order> q;
  const int count = potential_series(x, knot, step.scale, q);
  // the potential's series by recurrences, and its product with the solution's
  count_operations(20 * taylor_order + 4.0 * count * (taylor_order - 0.5 * count) + 8 * taylor_order);
  const double square = step.scale * step.scale;
  const double ai = equation_.a.imag();
  double* re = step.re;
  double* im = step.im;
  q[0] += equation_.a.real();
  const double size = std::abs(re[0]) + std::abs(im[0]) + std::abs(re[1]) + std::abs(im[1]);
  const bool tabulated = !taper_.table().pieces().empty();
  const auto small = [&](int n) { return std::abs(re[n]) + std::abs(im[n]) < 1e-19 * size; };
  for (int n = 0; n + 2 <= taylor_order; ++n) {
    if (n > 2 && tabulated && small(n + 1) && small(n) && small(n - 1)) {
      step.order = n + 1;
      std::fill(re + n + 2, re + taylor_order + 1, 0.0);
      std::fill(im + n + 2, im + taylor_order + 1, 0.0);
      break;
    }
    double sum_re = -ai * im[n];
    double sum_im = ai * re[n];
    for (int j = 0; j <= std::min(n, count - 1); ++j) {
      sum_re += q[static_cast<std::size_t>(j)] * re[n - j];
      sum_im += q[static_cast<std::size_t>(j)] * im[n - j];
    }
    const double factor = -square * inverse_products[static_cast<std::size_t>(n)];
    re[n + 2] = factor * sum_re;
    im[n + 2] = factor * sum_im;
  }
}

void SeriesMaker::fill(const TaylorState& from, TaylorStep& step) const {
  const double knot = taper_.previous_knot_m(from.x);
  step.x_start = from.x;
  step.scale = trial_scale(from.x);
  if (from.x - knot < step.scale && !taper_.table().pieces().empty()) step.scale = from.x - knot;
  step.ln_scale = from.ln_scale();
  // tau points towards the drive edge, opposite to x.
  const std::complex<double> dg = -from.dg * step.scale;
  step.re[0] = from.g.real();
  step.im[0] = from.g.imag();
  step.re[1] = dg.real();
  step.im[1] = dg.imag();
  const auto* taper = std::get_if<LinearTaper>(&taper_.form());
  if (taper != nullptr && taper->slope > 0) {
    count_operations((equation_.a.imag() != 0 ? 26 : 14) * taylor_order);
    equation_.a.imag() != 0 ? linear<true>(from.x, step) : linear<false>(from.x, step);
  } else {
    convolved(from.x, knot, step);
  }
  step.length = step.order < taylor_order ? step.scale : exact_length(step);
  // End exactly on the knot. If rounding left the step's end just short of it, another, tiny step would
  // follow.
  if (step.length > (from.x - knot) * (1 - 1e-9)) step.length = from.x - knot;
}

ApexSeries::ApexSeries(const Taper& taper, const MarchEquation& equation)
    : half_width_m_(std::get<LinearTaper>(taper.form()).half_width_m),
      slope_(std::get<LinearTaper>(taper.form()).slope),
      a_(equation.a) {
  mu_ = std::sqrt(equation.b / (slope_ * slope_) + equation.c + 0.25);
  // A point takes longer by this series than by a Taylor step, so the series is used only near the tip. If
  // its order mu is high, it is used farther in, because Taylor steps would have to be short there.
  const double share = 1 / (1 + 9 * std::min(1.0, 20 / mu_));
  const double reach = share * std::min(2 * std::sqrt(mu_ + 1), mu_) / std::sqrt(std::abs(equation.a));
  inner_m_ = std::max(0.0, half_width_m_ / slope_ - reach);
}

TaylorState ApexSeries::at(double x) const {
  const double s = std::max(0.0, std::fma(-slope_, x, half_width_m_) / slope_);
  if (s == 0) return {x, 0.0, 0.0, 0.0, 0};
  const std::complex<double> z = -0.25 * a_ * s * s;
  std::complex<double> term = 1, sum = 1, derivative = 0;
  for (int j = 1; j < 60; ++j) {
    term *= z / (j * (j + mu_));
    count_operations(20);
    sum += term;
    derivative += 2.0 * j * term;
    if (std::abs(term) * j < 1e-18 * std::abs(sum)) break;
  }
  const double power = mu_ + 0.5;
  // Use distances relative to the inner end of the series, which keeps the logarithm small.
  const double s1 = half_width_m_ / slope_ - inner_m_;
  return {x, sum, -(power * sum + derivative) / s, power * std::log(s / s1), 0};
}

}  // namespace turnpoint::physics
