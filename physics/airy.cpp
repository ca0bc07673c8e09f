#include "physics/airy.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace turnpoint::physics {
namespace {

constexpr double table_end = 10;
constexpr double spacing = 0.5;
constexpr int nodes = 41;
constexpr int kOrder = 24;
constexpr int terms = 18;
using Polynomial = std::array<double, kOrder + 1>;

struct Coefficients {
  std::array<double, terms> u{}, v{};
};

constexpr Coefficients asymptotic_coefficients() {
  Coefficients c;
  c.u[0] = c.v[0] = 1;
  for (int k = 1; k < terms; ++k) {
    const auto i = static_cast<std::size_t>(k);
    c.u[i] = c.u[i - 1] * (6.0 * k - 5) * (6.0 * k - 3) * (6.0 * k - 1) / (216.0 * k * (2.0 * k - 1));
    c.v[i] = (6.0 * k + 1) / (1 - 6.0 * k) * c.u[i];
  }
  return c;
}
constexpr Coefficients asymptotic = asymptotic_coefficients();

Airy decaying(double t) {
  const double zeta = 2.0 / 3 * t * std::sqrt(t);
  double u = 0, v = 0, power = 1;
  for (std::size_t k = 0; k < terms; ++k) {
    u += asymptotic.u[k] * power;
    v += asymptotic.v[k] * power;
    power *= -1 / zeta;
  }
  const double root = std::sqrt(std::sqrt(t));
  const double front = 0.5 / std::sqrt(std::numbers::pi);
  return {front * u / root, -front * v * root, -zeta};
}

Airy oscillating(double t) {
  const double z = -t;
  const double zeta = 2.0 / 3 * z * std::sqrt(z);
  // sums of the even and the odd terms of the asymptotic series in DLMF 9.7: first with the coefficients u,
  // then with v; the signs of the terms alternate
  double sums[4] = {0, 0, 0, 0};
  double power = 1;
  for (std::size_t k = 0; k < terms; ++k) {
    const double sign = (k / 2) % 2 == 0 ? 1 : -1;
    sums[k % 2] += sign * asymptotic.u[k] * power;
    sums[2 + k % 2] += sign * asymptotic.v[k] * power;
    power /= zeta;
  }
  const double c = std::cos(zeta - std::numbers::pi / 4), s = std::sin(zeta - std::numbers::pi / 4);
  const double root = std::sqrt(std::sqrt(z));
  const double front = 1 / std::sqrt(std::numbers::pi);
  return {front / root * (c * sums[0] + s * sums[1]), front * root * (s * sums[2] - c * sums[3]), 0};
}

Polynomial polynomial(double t0, double ai, double dai) {
  Polynomial c{};
  c[0] = ai;
  c[1] = dai;
  c[2] = 0.5 * t0 * c[0];
  for (std::size_t n = 1; n + 2 <= kOrder; ++n) {
    c[n + 2] = (t0 * c[n] + c[n - 1]) / static_cast<double>((n + 1) * (n + 2));
  }
  return c;
}

Airy at(const Polynomial& c, double h) {
  double value = c[kOrder], slope = 0;
  for (std::size_t k = kOrder; k-- > 0;) {
    slope = slope * h + value;
    value = value * h + c[k];
  }
  return {value, slope, 0};
}

std::array<Polynomial, nodes> make_table() {
  std::array<Polynomial, nodes> table;
  Airy y = decaying(table_end);
  y.ai *= std::exp(y.ln_scale);
  y.dai *= std::exp(y.ln_scale);
  for (int i = nodes - 1; i >= 0; --i) {
    const double t0 = -table_end + spacing * i;
    table[static_cast<std::size_t>(i)] = polynomial(t0, y.ai, y.dai);
    y = at(table[static_cast<std::size_t>(i)], -spacing / 2);
    y = at(polynomial(t0 - spacing / 2, y.ai, y.dai), -spacing / 2);
  }
  return table;
}

}  // namespace

Airy airy(double t) {
  static const std::array<Polynomial, nodes> table = make_table();
  if (t > table_end) return decaying(t);
  if (t < -table_end) return oscillating(t);
  const double index = std::round((t + table_end) / spacing);
  return at(table[static_cast<std::size_t>(index)], t - (-table_end + spacing * index));
}

}  // namespace turnpoint::physics
