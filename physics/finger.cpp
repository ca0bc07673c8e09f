#include "physics/finger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/modal_load.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

// The mirrored surface, x' = end_m - x, whose far end is the drive edge. The solver makes the field vanish at
// the far end, so on this surface it finds the solution that vanishes at the drive edge.
Surface reversed(const Surface& surface, double end_m) {
  Surface back = surface;
  back.length_m = end_m;
  const Taper taper(surface);
  if (const auto* exponential = std::get_if<ExponentialTaper>(&surface.taper)) {
    back.taper = ExponentialTaper{taper.half_width_m(end_m), -exponential->decay_length_m};
    return back;
  }
  std::vector<double> knots{0, end_m};
  for (const Cubic& piece : taper.table().pieces()) {
    if (piece.x0 > 0 && piece.x0 < end_m) knots.push_back(piece.x0);
  }
  std::sort(knots.rbegin(), knots.rend());
  TabulatedTaper table;
  for (const double x : knots) table.points.push_back({end_m - x, taper.half_width_m(x)});
  back.taper = table;
  return back;
}

class Loaded {
 public:
  Loaded(const Surface& surface, double f, double end_m, const Finger& finger)
      : surface_(surface),
        taper_(surface),
        back_surface_(reversed(surface, end_m)),
        equation_(march_equation(surface, f, Model::mode, Losses::kept)),
        tip_(taper_, equation_),
        drive_(Taper(back_surface_), equation_),
        end_m_(end_m),
        omega_(2 * std::numbers::pi * f),
        finger_(finger) {}

  FingerLoad at(double x) const {
    FingerLoad load;
    load.x_m = x;
    const Scaled v = tip_.value(x), v0 = tip_.value(0);
    load.unloaded = v.mantissa / v0.mantissa * std::exp(std::min(600.0, v.ln_scale - v0.ln_scale));
    const std::complex<double> g = green(x);
    const std::complex<double> i(0, 1);
    load.loaded = load.unloaded / (1.0 + i * omega_ * finger_.impedance_Ns_per_m * g);
    load.strip_impedance_Ns_per_m = 1 / std::max(1e-300, std::abs(omega_ * g));
    return load;
  }

 private:
  // The response f to a point force F solves N (W f')' + ... = -F delta: f = -F f1(x<) f2(x>) / (N W (f1 f2'
  // - f1' f2)).
  std::complex<double> green(double x) const {
    if (x <= 0 || x >= surface_.length_m) return 0;
    const std::complex<double> g2 = tip_.value(x).mantissa, d2 = tip_.slope(x).mantissa;
    const std::complex<double> g1 = drive_.value(end_m_ - x).mantissa,
                               d1 = -drive_.slope(end_m_ - x).mantissa;
    const double stiffness = line_tension_N_per_m(surface_) * taper_.half_width_m(x);
    return -(g1 * g2) / (stiffness * (g1 * d2 - d1 * g2));
  }

  Surface surface_;
  Taper taper_;
  Surface back_surface_;
  MarchEquation equation_;
  TaylorMarch tip_, drive_;
  double end_m_, omega_;
  Finger finger_;
};

void check(const Surface& surface) {
  validate(surface);
  if (surface.theory != PlateTheory::kirchhoff) {
    throw std::domain_error("finger load: plate theory kirchhoff only, not " +
                            std::string(name(surface.theory)));
  }
  if (bending_modelled(surface) && surface.edges == Edges::supported) {
    throw std::domain_error(
        "finger load: membranes and clamped plates only, not a plate with simply supported sides");
  }
}

// Computes the field of a clamped plate's one-shape mode, and its response to a point force.
std::vector<FingerLoad> plate_loads(const Surface& surface, double f, const std::vector<double>& x_m,
                                    const Finger& finger) {
  const auto line = make_centre_line(surface, f, Model::mode);
  const auto receptance = plate_receptance_m_per_N(surface, f, x_m);
  const std::complex<double> i_omega(0, 2 * std::numbers::pi * f);
  const Scaled v0 = line->value(0);
  std::vector<FingerLoad> all;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    FingerLoad load;
    const Scaled v = line->value(x_m[i]);
    load.x_m = x_m[i];
    load.unloaded = v.mantissa / v0.mantissa * std::exp(std::min(600.0, v.ln_scale - v0.ln_scale));
    load.loaded = load.unloaded / (1.0 + i_omega * finger.impedance_Ns_per_m * receptance[i]);
    load.strip_impedance_Ns_per_m = 1 / std::max(1e-300, std::abs(i_omega * receptance[i]));
    all.push_back(load);
  }
  return all;
}

// Position of the edge of |value| on an ascending grid: the last maximum, or the point beyond it with the
// given level.
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
  check(surface);
  double end = 0;
  for (const double x : x_m) {
    if (!(x >= 0 && x <= surface.length_m))
      throw std::invalid_argument("finger position: on the surface only");
    end = std::max(end, x);
  }
  if (Dispersion(surface).clamped_bending()) return plate_loads(surface, f, x_m, finger);
  // At the apex the solution from the drive edge is singular. Stop just before it, where the displacement is
  // zero in any case.
  if (const auto apex = Taper(surface).apex_m()) end = std::min(end, *apex * (1 - 1e-6));
  const Loaded loaded(surface, f, std::max(end, 1e-3 * surface.length_m), finger);
  std::vector<FingerLoad> all;
  for (const double x : x_m) all.push_back(loaded.at(std::min(x, std::max(end, 1e-3 * surface.length_m))));
  for (std::size_t i = 0; i < all.size(); ++i) all[i].x_m = x_m[i];
  return all;
}

std::optional<double> finger_edge_shift_m(const Surface& surface, double f, const Edge& edge,
                                          const Finger& finger) {
  if (edge.kind != Edge::Kind::peak && edge.kind != Edge::Kind::percent) {
    throw std::invalid_argument("finger edge shift: edge " + format(edge) + "; allowed: peak, percent edges");
  }
  constexpr int points = 2000;
  std::vector<double> x, free, loaded;
  for (int i = 0; i <= points; ++i) x.push_back(surface.length_m * 0.999 * i / points);
  for (const FingerLoad& load : finger_load(surface, f, x, finger)) {
    free.push_back(std::abs(load.unloaded));
    loaded.push_back(std::abs(load.loaded));
  }
  const auto from = feature(x, free, edge), to = feature(x, loaded, edge);
  return from && to ? std::optional(*to - *from) : std::nullopt;
}

}  // namespace turnpoint::physics
