#include "physics/element_basis.hpp"

namespace turnpoint::physics {
namespace {

struct Three {
  double value, first, second;
};

void set(BasisValues& all, int i, const Three& one) {
  const auto j = static_cast<std::size_t>(i);
  all.value[j] = one.value;
  all.first[j] = one.first;
  all.second[j] = one.second;
}

}  // namespace

BasisValues ElementBasis::at(double t) const {
  BasisValues all;
  const double u = 1 - t * t;
  const bool smooth = per_vertex == 2;
  const int last = count() - 1;
  if (smooth) {
    set(all, 0, {0.25 * (1 - t) * (1 - t) * (2 + t), -0.75 * u, 1.5 * t});
    set(all, 1, {0.25 * (1 - t) * (1 - t) * (1 + t), 0.25 * (3 * t * t - 2 * t - 1), 0.5 * (3 * t - 1)});
    set(all, last - 1, {0.25 * (1 + t) * (1 + t) * (2 - t), 0.75 * u, -1.5 * t});
    set(all, last, {-0.25 * (1 + t) * (1 + t) * (1 - t), 0.25 * (3 * t * t + 2 * t - 1), 0.5 * (3 * t + 1)});
  } else {
    set(all, 0, {0.5 * (1 - t), -0.5, 0});
    set(all, last, {0.5 * (1 + t), 0.5, 0});
  }
  const Three b = smooth ? Three{u * u, -4 * t * u, -4 * u + 8 * t * t} : Three{u, -2 * t, -2};
  double p0 = 1, p1 = t, d0 = 0, d1 = 1, s0 = 0, s1 = 0;
  for (int k = 0; k < bubbles(); ++k) {
    set(all, per_vertex + k,
        {b.value * p0, b.first * p0 + b.value * d0, b.second * p0 + 2 * b.first * d0 + b.value * s0});
    const double n = k + 2;
    const double p2 = ((2 * n - 1) * t * p1 - (n - 1) * p0) / n;
    const double d2 = ((2 * n - 1) * (p1 + t * d1) - (n - 1) * d0) / n;
    const double s2 = ((2 * n - 1) * (2 * d1 + t * s1) - (n - 1) * s0) / n;
    p0 = p1, p1 = p2, d0 = d1, d1 = d2, s0 = s1, s1 = s2;
  }
  return all;
}

}  // namespace turnpoint::physics
