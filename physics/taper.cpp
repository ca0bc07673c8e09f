#include "physics/taper.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::physics {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

MonotoneCubic join(const TaperForm& form) {
  const auto* table = std::get_if<TabulatedTaper>(&form);
  if (table == nullptr) return {};
  std::vector<double> x, w;
  for (const TaperPoint& point : table->points) {
    x.push_back(point.x_m);
    w.push_back(point.half_width_m);
  }
  return MonotoneCubic(x, w, table->slopes);
}

}  // namespace

Taper::Taper(const Surface& surface)
    : form_(surface.taper), table_(join(surface.taper)), length_m_(surface.length_m) {}

double Taper::half_width_m(double x) const {
  return std::visit(
      // Near the apex the difference is tiny. fma rounds only once; two roundings would lose all relative
      // accuracy.
      Overloaded{[x](const LinearTaper& t) { return std::fma(-t.slope, x, t.half_width_m); },
                 [x](const ExponentialTaper& t) { return t.half_width_m * std::exp(-x / t.decay_length_m); },
                 [this, x](const TabulatedTaper&) { return table_(x); }},
      form_);
}

double Taper::slope(double x) const {
  return std::visit(Overloaded{[](const LinearTaper& t) { return -t.slope; },
                               [x](const ExponentialTaper& t) {
                                 return -t.half_width_m / t.decay_length_m * std::exp(-x / t.decay_length_m);
                               },
                               [this, x](const TabulatedTaper&) { return table_.slope(x); }},
                    form_);
}

double Taper::second_derivative(double x) const {
  return std::visit(Overloaded{[](const LinearTaper&) { return 0.0; },
                               [this, x](const ExponentialTaper& t) {
                                 return half_width_m(x) / (t.decay_length_m * t.decay_length_m);
                               },
                               [this, x](const TabulatedTaper&) {
                                 const Cubic& p = table_.piece(x);
                                 return 2 * p.c2 + 6 * p.c3 * (x - p.x0);
                               }},
                    form_);
}

std::optional<double> Taper::position_continued_m(double w) const {
  if (!(w > 0)) return std::nullopt;
  return std::visit(Overloaded{[w](const LinearTaper& t) -> std::optional<double> {
                                 if (t.slope == 0) return std::nullopt;
                                 return (t.half_width_m - w) / t.slope;
                               },
                               [w](const ExponentialTaper& t) -> std::optional<double> {
                                 return t.decay_length_m * std::log(t.half_width_m / w);
                               },
                               [this, w](const TabulatedTaper&) -> std::optional<double> {
                                 if (w > half_width_m(0) || w < half_width_m(length_m_)) return std::nullopt;
                                 return table_.inverse(w);
                               }},
                    form_);
}

std::optional<double> Taper::position_m(double w) const {
  const auto x = position_continued_m(w);
  return x && *x >= 0 && *x <= length_m_ ? x : std::nullopt;
}

std::optional<double> Taper::apex_m() const {
  const auto* linear = std::get_if<LinearTaper>(&form_);
  if (linear == nullptr || linear->slope == 0) return std::nullopt;
  return linear->half_width_m / linear->slope;
}

double Taper::previous_knot_m(double x) const {
  const auto& pieces = table_.pieces();
  const auto next =
      std::partition_point(pieces.begin(), pieces.end(), [x](const Cubic& piece) { return piece.x0 < x; });
  return next == pieces.begin() ? 0 : std::max(0.0, (next - 1)->x0);
}

}  // namespace turnpoint::physics
