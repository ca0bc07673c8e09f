#include "station/scene/force_carrier.hpp"

#include <fmt/format.h>

#include <cmath>

#include "station/core/number.hpp"

namespace turnpoint::scene {

double captured_at(double frequency_Hz, int rate_Hz) {
  return std::abs(frequency_Hz - rate_Hz * std::round(frequency_Hz / rate_Hz));
}

std::string name(const ToneProduct& product) {
  const auto term = [](int factor, double frequency_Hz) {
    return (std::abs(factor) == 1 ? "" : fmt::format("{} x ", std::abs(factor))) +
           core::number(frequency_Hz, 7) + " Hz";
  };
  if (product.second == 0) return term(product.first, product.first_Hz);
  const double sum_Hz = product.first * product.first_Hz + product.second * product.second_Hz;
  std::string all = term(product.first, product.first_Hz) + " - " + term(product.second, product.second_Hz) +
                    " = " + core::number(std::abs(sum_Hz), 7) + " Hz";
  if (std::abs(std::abs(sum_Hz) - product.captured_Hz) > 0.5)
    all += ", captured at " + core::number(product.captured_Hz, 7) + " Hz";
  return all;
}

std::optional<ToneProduct> nearest_product(std::span<const double> tones_Hz, double near_Hz, int rate_Hz) {
  std::optional<ToneProduct> nearest;
  const auto see = [&](double f, double g, int first, int second) {
    ToneProduct product{f, g, first, second, captured_at(first * f + second * g, rate_Hz), 0};
    product.distance_Hz = std::abs(product.captured_Hz - near_Hz);
    if (!nearest || product.distance_Hz < nearest->distance_Hz) nearest = product;
  };
  for (const double f : tones_Hz) see(f, 0, 1, 0);
  for (const double f : tones_Hz)
    for (const double g : tones_Hz) {
      if (f == g) continue;
      see(f, g, 2, -1);
      for (int k = 1; k <= 4 && f > g; ++k) see(f, g, k, -k);
    }
  return nearest;
}

}  // namespace turnpoint::scene
