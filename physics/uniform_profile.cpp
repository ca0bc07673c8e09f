#include "physics/uniform_profile.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "physics/airy.hpp"
#include "physics/dispersion.hpp"
#include "physics/line_search.hpp"
#include "physics/root.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

// Eight-point Gauss-Legendre rule on [0, 1].
constexpr std::array<double, 8> nodes{0.0198550717512319, 0.1016667612931866, 0.2372337950418355,
                                      0.4082826787521751, 0.5917173212478249, 0.7627662049581645,
                                      0.8983332387068134, 0.9801449282487681};
constexpr std::array<double, 8> weights{0.0506142681451881, 0.1111905172266872, 0.1568533229389436,
                                        0.1813418916891810, 0.1813418916891810, 0.1568533229389436,
                                        0.1111905172266872, 0.0506142681451881};

// Values at one point: p, and the phase integral from the turning point, which is positive on both sides of
// it.
struct PhaseIntegral {
  double integral;
  double p;
};

class UniformLine final : public CentreLine {
 public:
  UniformLine(const Surface& surface, double f);
  Scaled value(double x) const override;
  // Uses a central difference of the logarithm. This shifts the last maximum by far less than the model's own
  // error.
  Scaled slope(double x) const override;
  std::optional<double> last_peak_m() const override {
    return turning_m_ < 0 ? std::nullopt : find_last_peak(*this, std::min(turning_m_, length_m_), 0.25 / k_);
  }
  std::optional<double> level_m(double level) const override {
    const auto peak = last_peak_m();
    return peak ? find_level(*this, *peak, length_m_, 0.25 / k_, level) : std::nullopt;
  }

 private:
  double potential(double x) const;
  double half_width(double x) const { return taper_.half_width_m(x); }
  PhaseIntegral phase(double x) const;
  PhaseIntegral linear_phase(double x) const;
  void find_turning();
  void tabulate();

  Taper taper_;
  MarchEquation equation_;
  double k_, length_m_;
  double turning_m_ = 0;
  double steepness_ = 0;  // -dp/dx at the turning point, with p of the equation g'' + p g = 0
  // Phase integrals from the turning point, towards the drive edge and towards the tip, at equal steps of u =
  // sqrt(distance from the turning point).
  std::array<std::vector<double>, 2> running_;
  double panel_ = 0;
};

UniformLine::UniformLine(const Surface& surface, double f)
    : taper_(surface),
      equation_(march_equation(surface, f, Model::mode, Losses::left_out)),
      k_(wavenumber_per_m(surface, f)),
      length_m_(surface.length_m) {
  // Langer's correction adds 1/4 to C of the equation, which makes the solution right at the apex
  if (taper_.apex_m()) equation_.c += 0.25;
  find_turning();
  if (!taper_.apex_m()) tabulate();
}

double UniformLine::potential(double x) const {
  const double w = half_width(x), slope = taper_.slope(x);
  return equation_.a.real() - (equation_.b + equation_.c * slope * slope) / (w * w);
}

void UniformLine::find_turning() {
  const auto* linear = std::get_if<LinearTaper>(&taper_.form());
  if (linear != nullptr && linear->slope == 0) throw std::domain_error("a strip has no turning point");
  if (linear != nullptr) {
    const double mu = std::sqrt(equation_.b / (linear->slope * linear->slope) + equation_.c);
    turning_m_ = linear->half_width_m / linear->slope - mu / k_;
    steepness_ = 2 * k_ * k_ * k_ / mu;
    return;
  }
  const Bracket ends{0, length_m_};
  if (!(potential(ends.above) > 0) || !(potential(ends.not_above) < 0)) {
    throw std::domain_error("no turning point on this surface: the uniform approximation does not exist");
  }
  turning_m_ = bisect(
                   ends, [&](double x) { return potential(x) > 0; },
                   [&](const Bracket& b) { return b.width() <= 1e-16 * length_m_; })
                   .middle();
  const double step = 1e-6 * length_m_;
  steepness_ = (potential(turning_m_ - step) - potential(turning_m_ + step)) / (2 * step);
}

// Sums the phase integrals over steps of u = sqrt(distance from the turning point), so that sqrt|p| dx =
// sqrt|p| 2 u du.
void UniformLine::tabulate() {
  panel_ = std::sqrt(length_m_) / 64;
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? -1 : 1;
    const double span = side == 0 ? turning_m_ : length_m_ - turning_m_;
    double sum = 0;
    running_[static_cast<std::size_t>(side)].push_back(0);
    for (double u0 = 0; u0 < std::sqrt(span); u0 += panel_) {
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double u = u0 + panel_ * nodes[i];
        const double x = turning_m_ + sign * std::min(u * u, span);
        sum += panel_ * weights[i] * 2 * u * std::sqrt(std::abs(potential(x)));
      }
      running_[static_cast<std::size_t>(side)].push_back(sum);
    }
  }
}

PhaseIntegral UniformLine::linear_phase(double x) const {
  const auto& linear = std::get<LinearTaper>(taper_.form());
  const double mu = std::sqrt(equation_.b / (linear.slope * linear.slope) + equation_.c);
  const double z = k_ * half_width(x) / linear.slope;
  const double root = std::sqrt(std::abs((z - mu) * (z + mu)));
  const double integral = z > mu ? root - mu * std::atan2(root, mu) : mu * std::log((mu + root) / z) - root;
  return {integral, k_ * k_ * (z - mu) * (z + mu) / (z * z)};
}

PhaseIntegral UniformLine::phase(double x) const {
  if (taper_.apex_m()) return linear_phase(x);
  const std::size_t side = x < turning_m_ ? 0 : 1;
  const double sign = side == 0 ? -1 : 1;
  const double end = std::sqrt(std::abs(x - turning_m_));
  const auto panel = std::min(static_cast<std::size_t>(end / panel_), running_[side].size() - 1);
  const double start = panel_ * static_cast<double>(panel);
  double sum = running_[side][panel];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double u = start + (end - start) * nodes[i];
    sum += (end - start) * weights[i] * 2 * u * std::sqrt(std::abs(potential(turning_m_ + sign * u * u)));
  }
  return {sum, potential(x)};
}

Scaled UniformLine::value(double x) const {
  const double w = half_width(x);
  if (!(w > 0)) return {0, 0};
  const double k0 = std::cbrt(steepness_);
  const double distance = k0 * (x - turning_m_);
  double zeta = -distance;               // the argument of Ai is -zeta
  double amplitude = 1 / std::sqrt(k0);  // the limit of (zeta/p)^(1/4) at the turning point
  if (std::abs(distance) > 1e-4) {
    const PhaseIntegral here = phase(x);
    const double size = std::pow(1.5 * here.integral, 2.0 / 3);
    zeta = distance < 0 ? size : -size;
    amplitude = std::pow(size / std::abs(here.p), 0.25);
  }
  const Airy y = airy(-zeta);
  return {y.ai * amplitude / std::sqrt(w), y.ln_scale};
}

Scaled UniformLine::slope(double x) const {
  const double step = 1e-4 / k_;
  const double low = std::max(0.0, x - step), high = std::min(length_m_, x + step);
  const Scaled a = value(low), b = value(high);
  return {(b.mantissa * std::exp(b.ln_scale - a.ln_scale) - a.mantissa) / (high - low), a.ln_scale};
}

}  // namespace

std::unique_ptr<CentreLine> make_uniform_line(const Surface& surface, double f) {
  if (Dispersion(surface).clamped_bending()) {
    throw std::domain_error("model uniform is not available for clamped plates; allowed: mode, modes");
  }
  return std::make_unique<UniformLine>(surface, f);
}

}  // namespace turnpoint::physics
