#include "physics/friction.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/gate.hpp"
#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

// If the skin contacts carry no more than this fraction of the load, friction counts as being at its floor.
constexpr double smallest_share = 0.02;
// Number of steps in the table of start values. It is fine enough that two Newton steps from a start value
// reach rounding accuracy.
constexpr int start_steps = 256;
// Standard deviation of ln(u_s) between fingers, which is assumed
constexpr double finger_length_sd = 0.3;

// Returns the excursion e (amplitude divided by gap) that causes an overpressure q (in units of the ambient
// pressure). It solves (1 + q)^2 = (1 + 3 e^2/2)/(1 - e^2).
double excursion(double overpressure) {
  const double r = overpressure * (2 + overpressure);  // equals (1 + q)^2 - 1, without cancellation
  return std::sqrt(r / (2.5 + r));
}

double with_floor(double share, double floor) {
  const double f4 = floor * floor * floor * floor;
  return std::sqrt(std::sqrt(f4 + (1 - f4) * share * share * share * share));
}

std::optional<double> without_floor(double friction, double floor) {
  const double f4 = std::pow(floor, 4);
  const double share4 = (std::pow(friction, 4) - f4) / (1 - f4);
  if (share4 < std::pow(smallest_share, 4)) return std::nullopt;
  return std::min(1.0, std::pow(share4, 0.25));
}

// The gap without vibration, where the contacts carry the whole load.
double rest_gap_m(const LoadSharing& m) {
  return m.decay_length_m * std::log(m.contact_pressure_Pa / m.pressure_Pa);
}

// Returns the displacement at which the skin contacts carry the fraction `share` of the load, in closed form:
// `share` determines the gap, the rest of the load determines the pressure of the air film, and this pressure
// determines the excursion.
double displacement_for_share(const LoadSharing& m, double share) {
  if (share >= 1) return 0;
  const double gap = rest_gap_m(m) - m.decay_length_m * std::log(share);
  return gap * excursion(m.pressure_Pa * (1 - share) / m.ambient_Pa);
}

// Returns the fraction (share) of the load that the skin contacts carry at a displacement. The air film must
// carry 1 - share. The difference between the overpressure that the film has and the one that it needs rises
// with ln(share), so Newton steps within a bracket find its zero.
double share_at(const LoadSharing& m, double displacement_m, double ln_guess) {
  const double lowest = std::log(smallest_share);
  const auto tangent = [&](double x) {
    const double share = std::exp(x);
    const double gap = rest_gap_m(m) - m.decay_length_m * x;
    const double e = displacement_m / gap;
    if (e >= 1) return Tangent{1, x};  // the displacement exceeds the gap: halve the bracket
    const double r = 2.5 * e * e / ((1 - e) * (1 + e));
    const double root = std::sqrt(1 + r);
    const double miss = m.ambient_Pa / m.pressure_Pa * r / (1 + root) - (1 - share);
    const double slope = m.ambient_Pa / m.pressure_Pa * (r + 2.5) * e / ((1 - e) * (1 + e) * root) * e *
                             m.decay_length_m / gap +
                         share;
    return Tangent{miss, x - miss / slope};
  };
  const auto close = [](double next, double x) { return std::abs(next - x) < 1e-16 + 1e-15 * std::abs(x); };
  return std::exp(newton({0, lowest}, std::max(lowest, ln_guess), tangent, close, 100));
}

}  // namespace

double squeeze_film_overpressure(double e) {
  require(e >= 0 && e < 1, "squeeze film excursion", e, "0 to below 1");
  // The overpressure is sqrt(1 + r) - 1 with r = 2.5 e^2/(1 - e^2). The code uses r / (sqrt(1 + r) + 1),
  // which does not cancel at small e.
  const double r = 2.5 * e * e / (1 - e * e);
  return r / (1 + std::sqrt(1 + r));
}

FrictionMap::FrictionMap(const LoadSharing& m) {
  require_size("pressure_Pa", m.pressure_Pa);
  require(m.floor >= 0 && m.floor < 1, "floor", m.floor, "0 to below 1");
  require_size("decay_length_m", m.decay_length_m);
  require_size("contact_pressure_Pa", m.contact_pressure_Pa);
  require(m.pressure_Pa <= 0.999 * m.contact_pressure_Pa, "pressure_Pa", m.pressure_Pa,
          "below the pressure that closes the gap (contact_pressure_Pa)");
  require_size("ambient_Pa", m.ambient_Pa);
  Sharing sharing{m, displacement_for_share(m, smallest_share), {0}};
  for (int i = 1; i <= start_steps; ++i) {
    const double a = sharing.highest_m * i / start_steps;
    sharing.ln_share.push_back(std::log(share_at(m, a, sharing.ln_share.back())));
  }
  model_ = std::move(sharing);
}

FrictionMap::FrictionMap(std::vector<FrictionPoint> table) {
  std::vector<double> a, mu, sd;
  for (const FrictionPoint& point : table) {
    require_size_or_0("displacement_m", point.displacement_m);
    require_size("relative_friction", point.relative_friction);
    require_size_or_0("sd of relative_friction", point.sd);
    require(mu.empty() || point.relative_friction < mu.back(), "relative_friction", point.relative_friction,
            "falling with displacement");
    a.push_back(point.displacement_m);
    mu.push_back(point.relative_friction);
    sd.push_back(point.sd);
  }
  if (table.size() < 2) throw std::invalid_argument("a friction table needs two or more points");
  require(a.front() == 0 && mu.front() == 1, "relative_friction at the first point", mu.front(),
          "1 at displacement 0");
  model_ = Table{MonotoneCubic(a, mu), MonotoneCubic(a, sd)};
}

double FrictionMap::relative_friction(double a) const {
  require(a >= 0 && std::isfinite(a), "displacement_m", a, "0 or more, finite");
  const auto* sharing = std::get_if<Sharing>(&model_);
  if (sharing == nullptr) return std::get<Table>(model_).friction(std::min(a, highest_displacement_m()));
  const LoadSharing& m = sharing->model;
  if (a == 0) return 1;
  if (a >= sharing->highest_m) return with_floor(smallest_share, m.floor);
  const double at = a / sharing->highest_m * start_steps;
  const auto i = std::min(static_cast<std::size_t>(at), std::size_t{start_steps - 1});
  const double t = at - static_cast<double>(i);
  const double guess = (1 - t) * sharing->ln_share[i] + t * sharing->ln_share[i + 1];
  return with_floor(share_at(m, a, guess), m.floor);
}

std::optional<double> FrictionMap::displacement_m(double friction) const {
  if (!(friction <= 1) || friction < lowest_friction()) return std::nullopt;
  if (const auto* sharing = std::get_if<Sharing>(&model_)) {
    const auto share = without_floor(friction, sharing->model.floor);
    return displacement_for_share(sharing->model, share.value_or(smallest_share));
  }
  return std::get<Table>(model_).friction.inverse(friction);
}

double FrictionMap::sd(double a) const {
  const auto* table = std::get_if<Table>(&model_);
  require(a >= 0 && std::isfinite(a), "displacement_m", a, "0 or more, finite");
  if (table != nullptr) return table->sd(std::clamp(a, 0.0, highest_displacement_m()));
  // All lengths of the model are proportional to u_s, so a finger with another u_s feels another
  // displacement.
  const double step = 1e-3, slope = relative_friction(a * (1 - step)) - relative_friction(a * (1 + step));
  return finger_length_sd * slope / (2 * step);
}

double FrictionMap::lowest_friction() const {
  if (const auto* s = std::get_if<Sharing>(&model_)) return with_floor(smallest_share, s->model.floor);
  return relative_friction(highest_displacement_m());
}

double FrictionMap::highest_displacement_m() const {
  if (const auto* s = std::get_if<Sharing>(&model_)) return s->highest_m;
  return std::get<Table>(model_).friction.pieces().back().x1;
}

namespace {

// Returns the integral of the piecewise linear function from x[0] to `position`. `running` is the integral up
// to each point.
double integral_to(std::span<const double> x, std::span<const double> y, std::span<const double> running,
                   double position) {
  const auto after = std::upper_bound(x.begin(), x.end(), position);
  const std::size_t i = std::min<std::size_t>(
      x.size() - 2, after == x.begin() ? 0 : static_cast<std::size_t>(after - x.begin() - 1));
  const double t = position - x[i];
  const double slope = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  return running[i] + t * (y[i] + 0.5 * slope * t);
}

}  // namespace

std::vector<double> fingertip_average(std::span<const double> x, std::span<const double> values,
                                      double fingertip_m) {
  if (x.size() != values.size() || x.size() < 2) {
    throw std::invalid_argument("fingertip average: needs as many values as points, and at least two");
  }
  require_size_or_0("fingertip_m", fingertip_m);
  for (std::size_t i = 0; i < x.size(); ++i) {
    require(std::abs(x[i]) <= largest_size, "x_m", x[i], "-1e18 to 1e18");
    require(std::abs(values[i]) <= largest_size, "value", values[i], "-1e18 to 1e18");
  }
  if (fingertip_m <= 1e-9 * (x.back() - x.front())) return {values.begin(), values.end()};
  std::vector<double> running(x.size(), 0.0), mean(x.size());
  for (std::size_t i = 1; i < x.size(); ++i) {
    require(x[i] - x[i - 1] >= least_size, "x_m", x[i], "ascending, in steps of at least 1e-18");
    running[i] = running[i - 1] + 0.5 * (values[i] + values[i - 1]) * (x[i] - x[i - 1]);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double low = std::max(x.front(), x[i] - fingertip_m / 2);
    const double high = std::min(x.back(), x[i] + fingertip_m / 2);
    mean[i] = (integral_to(x, values, running, high) - integral_to(x, values, running, low)) / (high - low);
  }
  return mean;
}

}  // namespace turnpoint::physics
