#include "physics/finger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/gate.hpp"
#include "physics/modal_load.hpp"

namespace turnpoint::physics {
namespace {

// Returns the position of the edge on an ascending grid x: the last maximum of |value|, or the outermost
// point beyond it at which |value| has the given level.
std::optional<double> feature(const std::vector<double>& x, const std::vector<double>& value,
                              const Edge& edge) {
  std::size_t peak = x.size() - 1;
  const double most = *std::max_element(value.begin(), value.end());
  while (peak > 0 && (value[peak - 1] >= value[peak] || value[peak] < 1e-3 * most)) --peak;
  if (peak == 0 || peak + 1 >= x.size()) return std::nullopt;
  const double a = value[peak - 1], b = value[peak], c = value[peak + 1];
  const double offset = 0.5 * (a - c) / (a - 2 * b + c);
  if (edge.kind == Edge::Kind::peak) return x[peak] + offset * (x[1] - x[0]);
  const double level = edge.level * (b - 0.25 * (a - c) * offset);
  for (std::size_t i = peak; i + 1 < x.size(); ++i) {
    if (value[i] >= level && value[i + 1] < level) {
      return x[i] + (x[i + 1] - x[i]) * std::log(value[i] / level) / std::log(value[i] / value[i + 1]);
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<FingerLoad> finger_load(const Surface& surface, double f, const std::vector<double>& x_m,
                                    const Finger& finger) {
  validate(surface, f);
  for (const double x : x_m) require_on_surface(surface, "finger position", x);
  require_size("contact_radius_m", finger.contact_radius_m);
  require(finger.contact_radius_m >= 1e-6 * surface.length_m && finger.contact_radius_m <= surface.length_m,
          "contact_radius_m", finger.contact_radius_m, "1e-6 to 1 times the surface's length");
  require(std::abs(finger.beside_m) <= surface.length_m, "beside_m", finger.beside_m,
          "not more than the surface's length");
  require(std::abs(finger.impedance_Ns_per_m) <= largest_size, "impedance_Ns_per_m",
          std::abs(finger.impedance_Ns_per_m), "up to 1e18");
  const std::complex<double> i_omega(0, 2 * std::numbers::pi * f);
  std::vector<FingerLoad> all;
  for (const DiscResponse& disc :
       disc_responses(surface, f, {finger.contact_radius_m, finger.beside_m}, x_m)) {
    FingerLoad load;
    load.x_m = x_m[all.size()];
    load.unloaded = disc.unloaded;
    load.mobility_m_per_Ns = i_omega * disc.receptance_m_per_N;
    load.loaded = load.under(finger);
    all.push_back(load);
  }
  return all;
}

std::vector<double> finger_sweep_m(const Surface& surface) {
  constexpr int points = 600;
  std::vector<double> x;
  for (int i = 0; i <= points; ++i) x.push_back(surface.length_m * 0.999 * i / points);
  return x;
}

std::optional<double> finger_edge_shift_m(std::span<const FingerLoad> sweep, const Edge& edge,
                                          const Finger& finger) {
  if (edge.kind != Edge::Kind::peak && edge.kind != Edge::Kind::percent) {
    throw std::invalid_argument("finger edge shift: edge " + format(edge) + "; allowed: peak, percent edges");
  }
  if (sweep.size() < 3)
    throw std::invalid_argument("finger edge shift: the loads at finger_sweep_m() are needed");
  std::vector<double> x, free, loaded;
  for (const FingerLoad& load : sweep) {
    x.push_back(load.x_m);
    free.push_back(std::abs(load.unloaded));
    loaded.push_back(std::abs(load.under(finger)));
  }
  const auto from = feature(x, free, edge), to = feature(x, loaded, edge);
  return from && to ? std::optional(*to - *from) : std::nullopt;
}

}  // namespace turnpoint::physics
