#include "station/simulation/first_passage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "station/core/elementary.hpp"

namespace turnpoint::simulation {

using std::numbers::pi;

namespace {

/// If drift times bound exceeds this value, an observer makes no errors. Limiting it to this value keeps
/// exp() from overflowing.
constexpr double kSurest = 300;

/// Returns the probability with which a time drawn from the inverse Gaussian distribution is accepted: the
/// density of the first passage through -1 or +1 without drift, divided by twice the density of the first
/// passage through +1 alone. (The latter also counts paths that went below -1 before.) The first density is a
/// series, of which there are two forms; this uses the form that needs fewer terms at this time.
double kept_share(double time) {
  double sum = 0, term = 1;
  if (time < 0.7) {
    for (int n = 0; term > 1e-17; ++n) {
      term = (2 * n + 1) * core::exp(-2.0 * n * (n + 1) / time);
      sum += n % 2 ? -term : term;
    }
    return sum;
  }
  for (int n = 0; term > 1e-17; ++n) {
    const double m = n + 0.5;
    term = m * core::exp(0.5 / time - 0.5 * m * m * pi * pi * time);
    sum += n % 2 ? -term : term;
  }
  return sum * pi * std::sqrt(0.5 * pi * time * time * time);
}

/// Draws the time that a walk with this drift (0 or more) needs from 0 to -1 or +1. At least half of the
/// proposed times are accepted.
double unit_passage(double drift, core::Draws& draws) {
  for (;;) {
    const double normal = draws.normal(), y = normal * normal;
    const double small = 2 / (2 * drift + y + std::sqrt(y * (y + 4 * drift)));
    const bool first = draws.uniform() * (1 + drift * small) < 1;
    const double time = first ? small : 1 / (drift * drift * small);
    const double keep = draws.uniform();
    if (time > 0 && time < 1e6 && keep < kept_share(time)) return time;
  }
}

}  // namespace

Passage first_passage(double drift, double bound, double start, core::Draws& draws) {
  Passage passage;
  double at = start;
  for (;;) {
    const double radius = 1 - std::fabs(at);
    const double width = radius * bound;
    const double pull = std::clamp(drift * width, -kSurest, kSurest);
    passage.time_s += width * width * unit_passage(std::fabs(pull), draws);
    passage.upper = draws.uniform() < upper_probability(pull, 1);
    if (at == 0 || passage.upper == (at > 0)) return passage;
    at += passage.upper ? radius : -radius;
  }
}

double upper_probability(double drift, double bound) {
  return 1 / (1 + core::exp(std::clamp(-2 * drift * bound, -2 * kSurest, 2 * kSurest)));
}

double upper_by(double drift, double bound, double time_s) {
  const double pull = std::clamp(drift * bound, -kSurest, kSurest), time = time_s / (bound * bound);
  if (time <= 0) return 0.5;
  // With pull = drift bound and time in units of bound^2, this is P(upper) - pull times the sum over odd n of
  // exp(-(pull^2 + (n pi / 2)^2) time / 2) / (pull^2 + (n pi / 2)^2).
  double sum = 0;
  for (int n = 1;; n += 2) {
    const double rate = pull * pull + 0.25 * n * n * pi * pi;
    const double term = core::exp(-0.5 * rate * time) / rate;
    sum += term;
    if (term < 1e-17 || n > 20000) break;
  }
  return upper_probability(pull, 1) - pull * sum;
}

double upper_probability(double drift, double bound, double range) {
  const double pull = std::clamp(drift * bound, -kSurest, kSurest), inner = 2 * pull * range;
  if (std::fabs(inner) < 1e-4) return upper_probability(pull, 1);
  if (pull < 0) return 1 - upper_probability(-drift, bound, range);
  // This is the mean of (1 - exp(-2 pull (1 + start))) / (1 - exp(-4 pull)) over all starting points from
  // -range to +range.
  const double hit = core::exp(inner - 2 * pull), miss = core::exp(-inner - 2 * pull);
  return (1 - (hit - miss) / (2 * inner)) / (1 - core::exp(-4 * pull));
}

}  // namespace turnpoint::simulation
