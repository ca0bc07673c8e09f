#include "station/simulation/delay.hpp"

#include <cmath>
#include <numbers>

namespace turnpoint::simulation {

namespace {

double bessel_i0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; term > sum * 1e-17; ++k) {
    term *= x * x / (4.0 * k * k);
    sum += term;
  }
  return sum;
}

}  // namespace

Delay::Delay(std::int64_t longest, double fraction) {
  std::int64_t size = 1;
  while (size < longest + kTaps + 1) size *= 2;
  samples_.assign(static_cast<std::size_t>(size), 0.0);
  mask_ = size - 1;
  if (fraction == 0) return;
  constexpr double beta = 8;
  double total = 0;
  for (int k = 0; k < kTaps; ++k) {
    const double t = k - kLeast + 1 - fraction;  // distance of tap k from the wanted point, in frames
    const double place = t / kLeast;
    const double window =
        place * place < 1 ? bessel_i0(beta * std::sqrt(1 - place * place)) / bessel_i0(beta) : 0;
    const double angle = std::numbers::pi * t;
    taps_.push_back(window * std::sin(angle) / angle);
    total += taps_.back();
  }
  for (double& tap : taps_) tap /= total;
}

}  // namespace turnpoint::simulation
