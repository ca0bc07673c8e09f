#include "physics/taylor_march.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/operations.hpp"
#include "physics/root.hpp"
#include "physics/taylor_kernel.hpp"
#include "physics/taylor_series.hpp"

namespace turnpoint::physics {
namespace {

// Largest number of samples per step in the search for maxima and zeros. One step covers at most about 4
// radians of phase.
constexpr int most_samples = 16;

struct Local {
  std::complex<double> g;
  std::complex<double> dg;  // the derivative dg/dx
};

// The value of `at` without the derivative.
std::complex<double> value_at(const TaylorStep& step, double x) {
  count_operations(4.0 * step.order);
  const double tau = (step.x_start - x) / step.scale;
  double re = step.re[step.order], im = step.im[step.order];
  for (int k = step.order - 1; k >= 0; --k) {
    re = re * tau + step.re[k];
    im = im * tau + step.im[k];
  }
  return {re, im};
}

Local at(const TaylorStep& step, double x) {
  count_operations(8.0 * step.order);
  const double tau = (step.x_start - x) / step.scale;
  double re = step.re[step.order], im = step.im[step.order];
  double dre = 0, dim = 0;
  for (int k = step.order - 1; k >= 0; --k) {
    dre = dre * tau + re;
    dim = dim * tau + im;
    re = re * tau + step.re[k];
    im = im * tau + step.im[k];
  }
  return {{re, im}, {-dre / step.scale, -dim / step.scale}};
}

}  // namespace

double Scaled::ln_magnitude() const {
  const double magnitude = std::abs(mantissa);
  return magnitude > 0 ? std::log(magnitude) + ln_scale : ln_zero;
}

struct TaylorMarch::State {
  Taper taper;
  MarchEquation equation;
  std::optional<ApexSeries> apex;  // the solution near the apex, for x > apex->inner_m()
  std::vector<TaylorStep> steps;   // from the tip to x = 0, or to the last maximum
  double held_m;                   // the outer end, where v is set to zero

  enum class Until { drive_edge, last_peak };
  void march(TaylorState from, Until until);
  const TaylorStep* step_at(double x) const;
  Local local(double x, double& ln_scale) const;
  std::complex<double> local_value(double x, double& ln_scale) const;
  Scaled value_of(std::complex<double> g, double x, double ln_scale) const;
  Scaled slope_of(const Local& g, double x, double ln_scale) const;
  double rise(const Local& g, double x) const;
  double bend(const Local& g, double x) const;
  std::optional<double> peak_in(const TaylorStep& step, double outermost) const;
  bool hidden_by_loss(double x) const;
  double outermost_maximum() const;
  int samples(const TaylorStep& step) const;
  void run(const TaylorStep& step, std::span<const double> x, double* re, double* im) const;
};

void TaylorMarch::State::march(TaylorState state, Until until) {
  const SeriesMaker maker(taper, equation);
  const double outermost = outermost_maximum();
  while (state.x > 0) {
    TaylorStep& step = steps.emplace_back();
    maker.fill(state, step);
    const double inner = std::max(0.0, step.x_start - step.length);
    const Local end = at(step, inner);
    state.x = inner;
    state.g = end.g;
    state.dg = end.dg;
    state.normalise(step.scale);
    if (until == Until::last_peak && (peak_in(step, outermost) || hidden_by_loss(state.x))) return;
  }
}

// True if loss has damped the reflected wave so much that |v| rises all the way from x to the drive edge.
// With k = k1 - i a, the reflected wave at a distance s from the turning point has e^-2as of the amplitude of
// the arriving wave. d ln|v|^2/dx then has three parts: 2a from loss, W'/W from the width, and a ripple of at
// most 4 k1 e^-2as from the reflected wave. The function compares them. W'/W does not grow towards the drive
// edge, except on a tabulated taper.
bool TaylorMarch::State::hidden_by_loss(double x) const {
  if (equation.a.imag() == 0 || std::holds_alternative<TabulatedTaper>(taper.form())) return false;
  const std::complex<double> k = std::sqrt(equation.a);
  const double loss = -k.imag(), width = -taper.slope(x) / taper.half_width_m(x);
  const auto turning = taper.position_continued_m(std::sqrt(equation.b) / k.real());
  if (!turning || !(loss > 2 * width)) return false;
  return 2 * loss * (*turning - x) > std::log(8 * k.real() / loss);
}

const TaylorStep* TaylorMarch::State::step_at(double x) const {
  if (apex && x > apex->inner_m()) return nullptr;
  const auto after = std::partition_point(steps.begin(), steps.end(),
                                          [x](const TaylorStep& s) { return s.x_start - s.length > x; });
  if (steps.empty()) return nullptr;
  return after == steps.end() ? &steps.back() : &*after;
}

Local TaylorMarch::State::local(double x, double& ln_scale) const {
  const TaylorStep* step = step_at(x);
  if (step != nullptr) {
    ln_scale = step->ln_scale;
    return at(*step, x);
  }
  const TaylorState state = apex->at(x);
  ln_scale = state.ln_scale();
  return {state.g, state.dg};
}

std::complex<double> TaylorMarch::State::local_value(double x, double& ln_scale) const {
  const TaylorStep* step = step_at(x);
  if (step == nullptr) return local(x, ln_scale).g;
  ln_scale = step->ln_scale;
  return value_at(*step, x);
}

Scaled TaylorMarch::State::value_of(std::complex<double> g, double x, double ln_scale) const {
  if (equation.w_power == 0 || g == 0.0) return {g, ln_scale};
  return {g * std::pow(taper.half_width_m(x), -equation.w_power), ln_scale};
}

Scaled TaylorMarch::State::slope_of(const Local& g, double x, double ln_scale) const {
  const double power = equation.w_power, w = taper.half_width_m(x);
  if (power == 0 || !(w > 0)) return {g.dg, ln_scale};
  return {std::pow(w, -power) * (g.dg - power * taper.slope(x) / w * g.g), ln_scale};
}

// Returns half of d|v|^2/dx times W^(2 w_power). It is positive where |v| rises with x.
double TaylorMarch::State::rise(const Local& g, double x) const {
  const double bend =
      equation.w_power == 0 ? 0 : equation.w_power * std::norm(g.g) * taper.slope(x) / taper.half_width_m(x);
  return (std::conj(g.g) * g.dg).real() - bend;
}

// The derivative of rise() with respect to x.
double TaylorMarch::State::bend(const Local& g, double x) const {
  const double w = taper.half_width_m(x), w1 = taper.slope(x), ratio = w1 / w, power = equation.w_power;
  const double square = std::norm(g.g), along = (std::conj(g.g) * g.dg).real();
  const double bracket = equation.a.real() - (equation.b + equation.c * w1 * w1) / (w * w);
  return std::norm(g.dg) - bracket * square -
         power * (2 * along * ratio + square * (taper.second_derivative(x) / w - ratio * ratio));
}

// The outermost position at which |v| can have a maximum. On a linear taper there is none in the evanescent
// zone, where Re p < 0: |g|^2 is convex there and starts from zero, so it grows at least in proportion to the
// distance from the tip, while W grows at most in that proportion. On an exponential taper of decay length l,
// v'' - v'/l + (a - b/W^2 - (c - w_power/2)/l^2) v = 0, and |v| has no maximum where the real part of the
// bracket is negative.
double TaylorMarch::State::outermost_maximum() const {
  if (const auto* curved = std::get_if<ExponentialTaper>(&taper.form())) {
    const double l = curved->decay_length_m;
    const double square = equation.a.real() - (equation.c - 0.5 * equation.w_power) / (l * l);
    if (!(square > 0)) return 0;
    return std::clamp(l * std::log(curved->half_width_m * std::sqrt(square / equation.b)), 0.0,
                      taper.length_m());
  }
  const auto* linear = std::get_if<LinearTaper>(&taper.form());
  if (linear == nullptr || linear->slope == 0) return taper.length_m();
  const double b = equation.b + equation.c * linear->slope * linear->slope;
  return std::max(0.0, (linear->half_width_m - std::sqrt(b / equation.a.real())) / linear->slope);
}

int TaylorMarch::State::samples(const TaylorStep& step) const {
  return std::clamp(static_cast<int>(4 * std::sqrt(std::abs(equation.a)) * step.length) + 1, 1, most_samples);
}

// Position of the outermost maximum of |v| within a step.
std::optional<double> TaylorMarch::State::peak_in(const TaylorStep& step, double outermost) const {
  double outer = std::min(step.x_start, outermost);
  double f_outer = rise(at(step, outer), outer);
  const int n = samples(step);
  for (int i = 1; i <= n; ++i) {
    double inner = i == n ? std::max(0.0, step.x_start - step.length) : step.x_start - step.length * i / n;
    if (inner >= outer) continue;
    double f_inner = rise(at(step, inner), inner);
    if (!(f_inner > 0 && f_outer <= 0)) {
      outer = inner;
      f_outer = f_inner;
      continue;
    }
    const auto tangent = [&](double x) {
      const Local g = at(step, x);
      const double f = rise(g, x);
      return Tangent{f, x - f / bend(g, x)};
    };
    const double start = Chord{inner, f_inner, outer, f_outer}.meets_0();
    // After a step as short as this, the error is negligible, because it is proportional to the square of the
    // step's length.
    return newton({inner, outer}, start, tangent,
                  [&](double next, double x) { return std::abs(next - x) <= 1e-12 * step.length; });
  }
  return std::nullopt;
}

TaylorMarch::TaylorMarch(const Taper& taper, const MarchEquation& equation) {
  auto state = std::make_unique<State>(State{taper, equation, {}, {}, taper.length_m()});
  state->steps.reserve(64);
  if (const auto* curved = std::get_if<ExponentialTaper>(&taper.form())) {
    const double half_widths =
        curved->decay_length_m / curved->half_width_m * std::expm1(taper.length_m() / curved->decay_length_m);
    if (half_widths > most_half_widths)
      throw std::domain_error("the taper is too long and narrow for a profile of all of it; allowed: maps");
  }
  const auto apex = taper.apex_m();
  if (apex && *apex <= taper.length_m() * (1 + 1e-9)) {
    state->apex.emplace(taper, equation);
    if (state->apex->inner_m() > 0)
      state->march(state->apex->at(state->apex->inner_m()), State::Until::drive_edge);
  } else {
    state->march({taper.length_m(), 0.0, -1.0, 0.0, 0}, State::Until::drive_edge);
  }
  state_ = std::move(state);
}

TaylorMarch::TaylorMarch(const Taper& taper, const MarchEquation& equation, double held_m) {
  auto state = std::make_unique<State>(State{taper, equation, {}, {}, held_m});
  state->steps.reserve(64);
  state->march({held_m, 0.0, -1.0, 0.0, 0}, State::Until::last_peak);
  state_ = std::move(state);
}

TaylorMarch::~TaylorMarch() = default;
TaylorMarch::TaylorMarch(TaylorMarch&&) noexcept = default;
TaylorMarch& TaylorMarch::operator=(TaylorMarch&&) noexcept = default;

int TaylorMarch::steps() const { return static_cast<int>(state_->steps.size()); }

Scaled TaylorMarch::value(double x) const {
  double ln_scale = 0;
  const std::complex<double> g = state_->local_value(x, ln_scale);
  return state_->value_of(g, x, ln_scale);
}

Scaled TaylorMarch::slope(double x) const { return motion(x).slope; }

TaylorMarch::Motion TaylorMarch::motion(double x) const {
  double ln_scale = 0;
  const Local g = state_->local(x, ln_scale);
  return {state_->value_of(g.g, x, ln_scale), state_->slope_of(g, x, ln_scale)};
}

std::optional<double> TaylorMarch::last_peak_m() const {
  const double outermost = state_->outermost_maximum();
  for (const TaylorStep& step : state_->steps) {
    if (step.x_start - step.length > outermost) continue;
    if (const auto peak = state_->peak_in(step, outermost)) return peak;
  }
  return std::nullopt;
}

std::optional<double> TaylorMarch::level_m(double level) const {
  const auto peak = last_peak_m();
  if (!peak) return std::nullopt;
  const double target = value(*peak).ln_magnitude() + std::log(level);
  double inner = *peak;
  double outer = state_->apex ? state_->apex->inner_m() : state_->held_m;
  if (state_->apex && value(outer).ln_magnitude() > target) {
    inner = outer;
    outer = state_->taper.length_m();
  }
  // Seen from the tip, |v| rises until the last maximum. The level therefore lies in the first step at whose
  // inner end |v| exceeds the level.
  for (const TaylorStep& step : state_->steps) {
    const double end = step.x_start - step.length;
    if (end <= inner) break;
    if (value(end).ln_magnitude() > target) {
      inner = end;
      break;
    }
    outer = end;
  }
  const auto tangent = [&](double x) {
    const Scaled v = value(x);
    const double miss = v.ln_magnitude() - target;
    const double log_slope = v.mantissa == 0.0 ? 0 : (slope(x).mantissa / v.mantissa).real();
    return Tangent{miss, x - miss / log_slope};
  };
  const auto close = [&](double next, double x) {
    return std::abs(next - x) <= 1e-16 * state_->taper.length_m();
  };
  const Bracket bracket{inner, outer};
  return newton(bracket, bracket.middle(), tangent, close);
}

int TaylorMarch::zeros() const {
  int count = 0;
  int sign = 0;
  for (const TaylorStep& step : state_->steps) {
    const int n = state_->samples(step);
    for (int i = 0; i <= n; ++i) {
      const double x =
          i == n ? std::max(0.0, step.x_start - step.length) : step.x_start - step.length * i / n;
      const double g = at(step, x).g.real();
      const int now = (g > 0) - (g < 0);
      if (now != 0 && sign != 0 && now != sign) ++count;
      if (now != 0) sign = now;
    }
  }
  return count;
}

namespace {

// Largest number of consecutive points that are evaluated together. The scratch arrays have this size.
constexpr std::size_t batch = 256;

struct Scratch {
  std::array<double, batch> re, im;
};

// Number of points from `first` on that lie within the step, at most `batch`.
std::size_t run_length(std::span<const double> x, std::size_t first, const TaylorStep& step, double end) {
  const double inner = step.x_start - step.length;
  const double outer = std::min(step.x_start, std::nextafter(end, 0));
  const std::size_t most = std::min(x.size(), first + batch);
  std::size_t i = first + 1;
  while (i < most && x[i] > inner && x[i] <= outer) ++i;
  return i - first;
}

}  // namespace

// Computes v = g W^-power for consecutive points that lie within one step.
void TaylorMarch::State::run(const TaylorStep& step, std::span<const double> x, double* re,
                             double* im) const {
  // the polynomial, the root of the width, the rotation, and the logarithm of the magnitude
  count_operations(static_cast<double>(x.size()) *
                   ((equation.a.imag() != 0 ? 4 : 2) * step.order + 2 * function_operations));
  if (equation.a.imag() != 0) {
    horner_complex(step, x.data(), x.size(), re, im);
  } else {
    horner_real(step, x.data(), x.size(), re);
  }
  if (equation.w_power == 0) return;
  if (const auto* linear = std::get_if<LinearTaper>(&taper.form())) {
    divide_by_root_width(linear->half_width_m, linear->slope, x.data(), x.size(), re, im);
    return;
  }
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double factor = std::pow(taper.half_width_m(x[j]), -equation.w_power);
    re[j] *= factor;
    im[j] *= factor;
  }
}

void TaylorMarch::evaluate(std::span<const double> x, std::complex<double> phase_reference,
                           double ln_reference, std::span<std::complex<double>> v,
                           std::span<double> ln_amplitude) const {
  const State& s = *state_;
  Scratch scratch;
  scratch.im.fill(0);
  const std::complex<double> turn = 1.0 / phase_reference;
  const double end = s.taper.length_m();
  const TaylorStep* step = nullptr;
  for (std::size_t i = 0; i < x.size();) {
    if (step == nullptr || !(x[i] > step->x_start - step->length && x[i] <= step->x_start))
      step = s.step_at(x[i]);
    // no Taylor step covers this point: the apex series does, or the point is the held end, where v is zero
    if (step == nullptr || x[i] >= end) {
      const Scaled one = value(x[i]);
      ln_amplitude[i] = one.mantissa == 0.0 ? ln_zero : one.ln_magnitude() - ln_reference;
      v[i] = one.mantissa * turn * std::exp(std::min(one.ln_scale - ln_reference, 700.0));
      ++i;
      continue;
    }
    const std::size_t n = run_length(x, i, *step, end);
    double* re = scratch.re.data();
    double* im = scratch.im.data();
    s.run(*step, x.subspan(i, n), re, im);
    const double ln_step = step->ln_scale - ln_reference;
    const std::complex<double> factor = turn * std::exp(std::min(ln_step, 700.0));
    rotate(re, im, n, factor.real(), factor.imag(), reinterpret_cast<double*>(&v[i]));
    if (!half_log_square(re, im, n, ln_step, &ln_amplitude[i])) {
      // v is too small for half_log_square() here, so compute each logarithm separately
      for (std::size_t j = 0; j < n; ++j) {
        const double magnitude = std::hypot(re[j], im[j]);
        ln_amplitude[i + j] = magnitude > 0 ? std::log(magnitude) + ln_step : ln_zero;
      }
    }
    i += n;
  }
}

}  // namespace turnpoint::physics
