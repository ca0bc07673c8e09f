#include "physics/elastic_section.hpp"
#include "physics/gate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "physics/root.hpp"
#include "physics/section_elements.hpp"

namespace turnpoint::physics {
namespace {

// Wavenumber times half-width, k W, of a thin clamped strip at its cut-off: the root of tan b + tanh b = 0.
constexpr double thin_root = 2.3650203724313520;

}  // namespace

double elastic_cut_off(double t, double poisson) {
  require(t >= 1e-3 && t <= 2, "thickness over half-width", t, "0.001 to 2");
  require(poisson >= 0 && poisson <= 0.49, "poisson", poisson, "0 to 0.49");
  return section_cut_off(SectionElements(t, poisson).pencil).omega;
}

ElasticCutOff::ElasticCutOff(double poisson)
    : kirchhoff_(thin_root * thin_root / std::sqrt(6 * (1 - poisson))) {
  std::array<double, terms> ratio{};
  for (std::size_t j = 0; j < terms; ++j) {
    const double x = std::cos(std::numbers::pi * (static_cast<double>(j) + 0.5) / terms);
    const double t = 0.5 * largest * (1 + x);
    ratio[j] = elastic_cut_off(t, poisson) / (kirchhoff_ * t);
  }
  for (std::size_t k = 0; k < terms; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < terms; ++j)
      sum += ratio[j] *
             std::cos(std::numbers::pi * static_cast<double>(k) * (static_cast<double>(j) + 0.5) / terms);
    coefficient_[k] = sum * (k == 0 ? 1 : 2) / terms;
  }
}

const ElasticCutOff& ElasticCutOff::of(double poisson) {
  static std::mutex mutex;
  static std::map<double, ElasticCutOff> tables;
  require(poisson >= 0 && poisson <= 0.49, "poisson", poisson, "0 to 0.49");
  const std::lock_guard lock(mutex);
  const auto found = tables.find(poisson);
  return found != tables.end() ? found->second
                               : tables.emplace(poisson, ElasticCutOff(poisson)).first->second;
}

double ElasticCutOff::value(double t) const noexcept {
  const double at = std::min(t, largest), x = 2 * at / largest - 1;
  double b1 = 0, b2 = 0;
  for (std::size_t k = terms - 1; k > 0; --k) {
    const double b0 = 2 * x * b1 - b2 + coefficient_[k];
    b2 = b1;
    b1 = b0;
  }
  return kirchhoff_ * at * (x * b1 - b2 + coefficient_[0]);
}

double ElasticCutOff::thickness_per_half_width(double wanted) const noexcept {
  if (wanted >= largest * value(largest)) return wanted / value(largest);
  const auto miss = [&](double t) { return t * value(t) - wanted; };
  return false_position({0, -wanted, largest, miss(largest)}, miss, {8, true}, 0,
                        [](const Chord& c) { return c.width() <= 1e-15 * c.right; });
}

}  // namespace turnpoint::physics
